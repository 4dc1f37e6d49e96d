// What a raster of roads that roadfix wrote says of itself in its metadata, so that it can be ingested again as what it
// is.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/units/provenance.hpp"
#include "tiles/sources/gdal_session.hpp"

namespace roadfix {

/// How descriptions of what is exported begin.
inline constexpr std::string_view kExportedRoads = "Probability of road, by Roadfix";

/// Whether it is a map, or says that another program copied it from one.
bool is_called_as_maps_are(GDALDataset& dataset);

/// Whether it says so, that it is a feature map, or is called as maps are; or whether the first image of a VRT does.
/// Then bytes are probabilities k / 254.
bool holds_exported_roads(GDALDataset& dataset);

/// Of what holds exported roads: whether another program made it, without what a map or an export tells of itself.
bool is_bare_copy_of_roads(GDALDataset& dataset);

/// Names and values of the metadata that tell it; nothing of what is not known.
std::vector<std::pair<std::string, std::string>> provenance_items(const Provenance& provenance);

/// What these items of a file tell; errors that are no positive number and texts that are no UTF-8 tell nothing.
Provenance provenance_in(GDALDataset& dataset);

}  // namespace roadfix
