// Is every tile of a map whole, and does the fused map follow from the evidence?
#pragma once

#include <cstdint>
#include <filesystem>
#include <stop_token>
#include <string>
#include <vector>

#include "core/units/progress.hpp"
#include "tiles/store/map_records.hpp"

namespace roadfix {

struct MapProblem {
  std::string code;  ///< stable, for scripts: "tile-corrupt", "tile-not-fused", "ledger-broken", ...
  std::string what;  ///< what is wrong, where, what to do
};

struct MapVerdict {
  std::int64_t tiles = 0;     ///< fused tiles and overviews that were checked
  std::int64_t evidence = 0;  ///< tiles of evidence that were checked
  std::vector<MapProblem> problems;
  // No damage, but of interrupted commands: ground may be missing, or not show its newest evidence yet.
  std::vector<SourceStatus> unfinished;
  std::int64_t tiles_to_fuse = 0;
};

/// Reads everything: the database structure, the tile lattice, every tile of evidence, every fused tile against the
/// evidence, every overview against the level below, the heights of the ground, ancillary rows, ledger, extent and
/// version. Throws what MapReader throws for files that cannot be opened as a map; everything else becomes a problem.
/// Throws Interrupted ("work-stopped"), and InUse ("map-changed") when a writer changed the map meanwhile.
MapVerdict verify_map(const std::filesystem::path& path, const OnProgress& progress = {}, std::stop_token stop = {});

}  // namespace roadfix
