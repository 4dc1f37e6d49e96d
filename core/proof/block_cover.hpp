// Which blocks of a map (bound_map.hpp) a footprint covers while its nadir is anywhere in a block.
#pragma once

#include <span>
#include <vector>

#include "core/grid/cell_array.hpp"
#include "core/proof/line_stencil.hpp"

namespace roadfix {

/// Of side x side blocks, row by row, with the nadir's block in the middle.
struct BlockCover {
  int side = 0;                    ///< odd
  std::vector<bool> inner, outer;  ///< wholly covered from every position of the nadir's block; partly, from any
};

/// By the observed cells, with the nadir in the cell `nadir`.
BlockCover cover_of(const CellArray& cells, CellOffset nadir);

/// `inner`: covered by all of them; `outer`: by any of them.
BlockCover common_cover(std::span<const BlockCover* const> covers);

}  // namespace roadfix
