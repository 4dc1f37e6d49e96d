#include "core/match/map_plane.hpp"

#include <algorithm>

namespace roadfix {

MapPlane::MapPlane(const CellArray& cells, int margin)
    : cols_(cells.cols()),
      rows_(cells.rows()),
      margin_(margin),
      stride_(cells.cols() + 2 * static_cast<std::ptrdiff_t>(margin)),
      bytes_(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(rows_ + 2 * margin) + kOverread,
             kUnobserved) {
  assert(margin >= 0);
  for (int r = 0; r < rows_; ++r) std::ranges::copy(cells.row(r), bytes_.begin() + (r + margin_) * stride_ + margin_);
}

}  // namespace roadfix
