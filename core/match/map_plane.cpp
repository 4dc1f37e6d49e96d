#include "core/match/map_plane.hpp"

namespace roadfix {

MapPlane::MapPlane(const CellArray& cells) : cols_(cells.cols()), rows_(cells.rows()) {
  const auto all = cells.cells();
  bytes_.reserve(all.size() + kOverread);
  bytes_.assign(all.begin(), all.end());
  bytes_.resize(all.size() + kOverread, kUnobserved);
}

}  // namespace roadfix
