// The blocks of a source on their way into the map: several are read at a time, and those that are there are written.
// For ingest(); not for other modules.
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

/// Carries the blocks that are still `open`, of which `done` others of the source were before. Ends early when asked to
/// stop, and at the first failure of source or writer, which it throws once all that was read by then is written.
/// Returns the number of observed cells in what was written.
std::int64_t carry_blocks(const BlockFlow& flow, std::span<const TileIndex> open, std::int64_t done);

}  // namespace roadfix
