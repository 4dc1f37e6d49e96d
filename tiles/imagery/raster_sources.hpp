// Sources of a map that are rasters: imagery, in which roads have to be detected, and rasters that already say where
// the roads are.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/detect/road_detector.hpp"
#include "core/geodesy/utm.hpp"
#include "tiles/imagery/raster_file.hpp"
#include "tiles/sources/cell_source.hpp"

namespace roadfix {

/// Pixel size that divides `cell_m` by a power of two and is nearest to what the detector prefers, or to the pixels of
/// the imagery where those are coarser.
double detection_gsd_m(double cell_m, double preferred_gsd_m, double native_gsd_m);

/// Roads that `detector` sees in the imagery. Each block is read with the detector's halo, so that blocks join without
/// seams. A block without data is unobserved and not looked at. The detector must outlive the source.
/// Throws what Mosaic does, and InvalidInput "imagery-too-coarse" for pixels above kCoarsestGsdM.
std::unique_ptr<CellSource> open_imagery(const std::vector<std::string>& paths, const RasterOptions& options,
                                         UtmZone zone, double cell_m, const RoadDetector& detector);

/// Rasters of road: integers are masks (0 = no road, the largest value = road; they carry the certainties of drawn
/// roads, see certainty.hpp), floats are probabilities and stay as they are. Averaged over the area of each cell,
/// which is observed where at least half of that is. Throws what Mosaic and notes_on_road_values() do.
std::unique_ptr<CellSource> open_road_raster(const std::vector<std::string>& paths, const RasterOptions& options,
                                             UtmZone zone, double cell_m);

}  // namespace roadfix
