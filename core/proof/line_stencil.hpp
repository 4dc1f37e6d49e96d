// Short straight lines of cells in all directions: the pieces of roads, shared by the map's and the feature map's part
// of the bound (bound_map.hpp, turned_features.hpp).
#pragma once

#include <array>
#include <vector>

namespace roadfix {

struct CellOffset {
  int col = 0;
  int row = 0;
};

inline constexpr int kLineDirections = 32;  ///< over half a turn

/// Cells of the digital line of direction `index` * pi / kLineDirections (from columns towards rows) around (0, 0):
/// about 16 cells long.
const std::vector<CellOffset>& line_stencil(int index);

}  // namespace roadfix
