// Carries the blocks of a source into the map: several are read at a time, each is written when it is ready. For
// ingest(); not for other modules.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "tiles/pipeline/ingest.hpp"

namespace roadfix {

/// What stays the same for all blocks.
struct BlockFlow {
  const CellSource& source;
  const std::string& name;  ///< of the source in the map
  MapWriter& writer;
  const IngestOptions& options;
};

/// Carries the blocks that are still `open`; `done` others were finished before, for the progress. Ends early when
/// asked to stop, and at the first failure of source or writer, which it throws after writing what was read by then.
/// Returns the number of observed cells written.
std::int64_t carry_blocks(const BlockFlow& flow, std::span<const TileIndex> open, std::int64_t done);

}  // namespace roadfix
