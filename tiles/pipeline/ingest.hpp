// From a source to a map: plans the blocks, reads and detects them in parallel, writes them one by one, fuses.
//
// Memory is bounded by the blocks in flight. A block's seed follows from the run's seed and the block's place alone, so
// the cells do not depend on the number of jobs, the order of blocks or how often the work was interrupted.
#pragma once

#include <cstdint>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "core/units/progress.hpp"
#include "tiles/pipeline/source_shift.hpp"
#include "tiles/sources/cell_source.hpp"
#include "tiles/store/map_records.hpp"
#include "tiles/store/map_writer.hpp"

namespace roadfix {

struct IngestOptions {
  int jobs = 1;  ///< blocks read and detected at a time, at least 1
  std::uint64_t seed = 1;
  bool replace = false;  ///< a source of that name with another fingerprint
  OnProgress on_blocks{};
  OnProgress on_fusing{};
  OnProgress on_shifts{};
  std::stop_token stop{};
};

struct IngestReport {
  std::int64_t blocks = 0;          ///< of the source
  std::int64_t blocks_before = 0;   ///< of these, done in earlier runs
  std::int64_t observed_cells = 0;  ///< of the blocks of this run
  double reading_s = 0.0;           ///< reading and detecting
  double fusing_s = 0.0;
  ShiftReport shifts{};  ///< of this source and those on its ground
};

/// Tiles of the map's lattice that the source touches, row by row from the north-west, at least one. `name`
/// is for messages. Throws InvalidInput "source-outside-map", LimitExceeded "source-too-large" beyond a million.
std::vector<TileIndex> plan_blocks(const CellSource& source, const std::string& name, const MapSettings& settings);

/// Seed of a block's random numbers.
std::uint64_t block_seed(std::uint64_t seed, TileIndex block);

/// Reads the source into the map, or goes on where an earlier call was stopped, and measures which sources on its
/// ground are shifted against the others (source_shift.hpp). `record.fingerprint` must cover everything that changes
/// the cells. Throws Interrupted "work-stopped" when asked to stop, and whatever source and writer throw; finished
/// blocks stay.
IngestReport ingest(const CellSource& source, const SourceRecord& record, MapWriter& writer,
                    const IngestOptions& options);

}  // namespace roadfix
