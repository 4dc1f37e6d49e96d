// Which UTM zone a map gets, and what is said of sources that lie in another one than the map, or far from it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "cli/ingest/ingest_options.hpp"
#include "core/detect/road_detector.hpp"
#include "tiles/sources/cell_source.hpp"
#include "tiles/store/map_records.hpp"

namespace roadfix::cli {

/// Those of the map, if it is there: then --cell and --zone must not contradict.
MapSettings settings_of(const IngestArguments& arguments, const SourceRequest& first, const RoadDetector* detector);

struct PlannedSource {
  std::unique_ptr<CellSource> cells;
  std::int64_t blocks = 0;
};
/// Throws what open_source and plan_blocks throw, and InvalidInput "source-in-another-zone" in their place where the
/// source lies in a zone that is too far from that of the map.
PlannedSource plan_source(const SourceRequest& request, const MapSettings& settings, const RoadDetector* detector);

/// What to tell of a source that reaches beyond the zone of the map.
std::vector<std::string> zone_notes(const CellSource& source, const MapSettings& settings);

}  // namespace roadfix::cli
