// A window of cells as GeoTIFF in memory, also one that is turned against the grid.
#pragma once

#include <array>
#include <string>

#include "core/geodesy/utm.hpp"
#include "core/grid/cell_array.hpp"
#include "tiles/store/map_records.hpp"

namespace roadfix {

/// One Float32 band, 0..1, nodata -1, deflated. `geotransform` is GDAL's: from (column, row) to east and north of the
/// zone. At least one cell. `info` is of the map that they were cut out of, for its credits. Throws IoFailure
/// ("export-failed").
std::string window_tiff(const CellArray& cells, const UtmZone& zone, const std::array<double, 6>& geotransform,
                        const MapInfo& info);

}  // namespace roadfix
