#include "core/match/map_plane.hpp"

#include <algorithm>

namespace roadfix {

MapPlane::MapPlane(const CellArray& cells)
    : cols_(cells.cols()),
      rows_(cells.rows()),
      all_observed_(std::ranges::find(cells.cells(), kUnobserved) == cells.cells().end()) {
  const auto all = cells.cells();
  bytes_.reserve(all.size() + kOverread);
  bytes_.assign(all.begin(), all.end());
  bytes_.resize(all.size() + kOverread, kUnobserved);
}

}  // namespace roadfix
