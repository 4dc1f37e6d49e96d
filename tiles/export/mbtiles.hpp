// What GDAL leaves out of the MBTiles that it copies. Not for other modules.
#pragma once

#include <gdal_priv.h>

#include <filesystem>

#include "tiles/store/map_records.hpp"

namespace roadfix {

/// Zooms below that of the tiles, down to the one that shows all of it in one: without them a viewer shows nothing
/// unless it is close. Returns false where GDAL failed or `progress` said to stop.
bool add_zooms(GDALDataset& tiles, GDALProgressFunc progress, void* monitor);

/// Of the metadata (MBTiles 1.3) "minzoom", which GDAL gives as 0 whatever there is, "attribution", unless empty, and
/// what ingest reads back. Throws IoFailure ("export-failed").
void complete_metadata(const std::filesystem::path& tiles, const MapInfo& info);

}  // namespace roadfix
