// A finished block on its own, where a test has no others to write with it.
#pragma once

#include <span>
#include <string>
#include <utility>

#include "tiles/store/map_writer.hpp"

namespace roadfix::testing {

inline void put_block(MapWriter& writer, const std::string& source, TileIndex block, CellArray cells) {
  const FinishedBlock finished{block, std::move(cells)};
  writer.put_blocks(source, std::span(&finished, 1));
}

}  // namespace roadfix::testing
