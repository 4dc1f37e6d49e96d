#include "core/match/map_plane.hpp"

namespace roadfix {

MapPlane::MapPlane(const CellArray& cells, int margin)
    : cols_(cells.cols()),
      rows_(cells.rows()),
      margin_(margin),
      stride_(cells.cols() + 2 * static_cast<std::ptrdiff_t>(margin)) {
  assert(margin >= 0);
  const auto side = static_cast<std::size_t>(margin);
  const auto stride = static_cast<std::size_t>(stride_);
  const std::size_t size = stride * (static_cast<std::size_t>(rows_) + 2 * side) + kOverread;
  bytes_.reserve(size);
  bytes_.resize(stride * side + side, kUnobserved);
  for (int r = 0; r < rows_; ++r) {
    const auto row = cells.row(r);
    bytes_.insert(bytes_.end(), row.begin(), row.end());
    bytes_.resize(bytes_.size() + 2 * side, kUnobserved);
  }
  bytes_.resize(size, kUnobserved);
}

}  // namespace roadfix
