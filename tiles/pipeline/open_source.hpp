// One way to open any kind of source for a map.
#pragma once

#include <cstdint>
#include <memory>

#include "core/detect/road_detector.hpp"
#include "core/geodesy/latlon.hpp"
#include "tiles/imagery/collar.hpp"
#include "tiles/imagery/raster_sources.hpp"
#include "tiles/roads/road_lines.hpp"
#include "tiles/roads/road_rules.hpp"
#include "tiles/sources/cell_source.hpp"
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

/// What the source says of itself; for a map of roadfix as source also the provenance of its own sources. Throws
/// InvalidInput "map-from-older-version".
SourceSummary summary_of(const CellSource& source, const SourceFiles& files);

/// With the registration error as its only provenance; describe_source() adds the rest. `seed` is that of the ingest:
/// it is part of the fingerprint, since it changes the cells.
SourceRecord record_of(const SourceFiles& files, const SourceSummary& summary, std::uint64_t seed);

/// A new map gets the zone of its first source. Around the equator that is the southern one: its lattice goes on for
/// 485 km to the north of it, while that of the northern one ends there.
MapSettings settings_of_new_map(const SourceRequest& first, double cell_m, const RoadDetector* detector);

}  // namespace roadfix
