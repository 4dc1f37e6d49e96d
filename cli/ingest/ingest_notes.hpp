// What `roadfix ingest` tells the user of a source in view of what its map holds, before the ingest and after it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tiles/pipeline/source_shift.hpp"
#include "tiles/sources/cell_source.hpp"
#include "tiles/store/map_records.hpp"

namespace roadfix::cli {

/// The source lies farther from the map's extent than that is wide: it may be in the wrong place. None for a new map.
std::optional<std::string> note_on_distance(const CellSource& source, const std::optional<MapInfo>& map);

/// `--replace` of a source that the map does not have: a newer version often has another file name, and would be added
/// to the older one.
std::optional<std::string> note_on_nothing_replaced(const std::optional<MapInfo>& map, const std::string& source);

/// `--replace` by a source that leaves out ground: new imagery of the worst quarter of a town is no newer version of
/// the imagery of the town.
std::optional<std::string> note_on_ground_lost(const CellSource& newer, const std::string& map,
                                               const std::string& source, double cell_m);

/// Why no cell of the source was observed.
std::string why_nothing_observed(const CellSource& source, double cell_m);

/// On stderr: the source is a copy of others. `twins` have exactly the same cells.
void note_copies(const std::vector<std::string>& twins, const std::string& source, const std::string& map,
                 const ShiftReport& shifts);

/// On stderr: which sources are shifted, this one first.
void note_shifts(const std::string& source, const ShiftReport& shifts);

}  // namespace roadfix::cli
