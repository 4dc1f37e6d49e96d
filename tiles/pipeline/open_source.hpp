// One way to open any kind of source for a map.
#pragma once

#include <cstdint>
#include <memory>

#include "core/detect/road_detector.hpp"
#include "core/geodesy/latlon.hpp"
#include "tiles/sources/cell_source.hpp"
#include "tiles/sources/collar.hpp"
#include "tiles/sources/raster_sources.hpp"
#include "tiles/sources/road_lines.hpp"
#include "tiles/sources/road_rules.hpp"
#include "tiles/sources/source_files.hpp"
#include "tiles/store/map_records.hpp"

namespace roadfix {

struct SourceRequest {
  SourceFiles files;
  RasterOptions raster;
  VectorOptions vectors;
  RoadRules rules;
};

/// Geographic centre of the first file that holds something, to choose the zone of a new map by.
LatLon centre_of_source(const SourceRequest& request);

/// `detector` is needed for imagery and must outlive the source.
std::unique_ptr<CellSource> open_source(const SourceRequest& request, const MapSettings& settings,
                                        const RoadDetector* detector);

/// What the source says of itself; of another map also what it was told of its own sources. Throws InvalidInput
/// "map-from-older-version".
SourceSummary summary_of(const CellSource& source, const SourceFiles& files);

/// As the source itself has it, but for what `summary.told` holds. `seed` is that of the ingest, which changes the
/// cells.
SourceRecord record_of(const SourceFiles& files, const SourceSummary& summary, std::uint64_t seed);

/// A new map gets the zone of its first source; around the equator the southern one, whose cells go on for 485 km
/// beyond it, where those of the northern one end.
MapSettings settings_of_new_map(const SourceRequest& first, double cell_m, const RoadDetector* detector);

}  // namespace roadfix
