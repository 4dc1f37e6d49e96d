// What a raster that roadfix exported says of itself in its metadata, so that it can be ingested again as what it is.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/units/provenance.hpp"
#include "tiles/sources/gdal_session.hpp"

namespace roadfix {

/// Names and values of the metadata that tell it; nothing of what is not known.
std::vector<std::pair<std::string, std::string>> provenance_items(const Provenance& provenance);

/// What these items of a file tell; errors that are no positive number and texts that are no UTF-8 tell nothing.
Provenance provenance_in(GDALDataset& dataset);

}  // namespace roadfix
