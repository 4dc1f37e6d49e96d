#include "core/match/map_plane.hpp"

#include <cstring>

namespace roadfix {

MapPlane::MapPlane(const CellArray& cells) : cols_(cells.cols()), rows_(cells.rows()) {
  const auto all = cells.cells();
  bytes_.reserve(all.size() + kOverread);
  bytes_.assign(all.begin(), all.end());
  all_observed_ = std::memchr(bytes_.data(), kUnobserved, bytes_.size()) == nullptr;
  bytes_.resize(all.size() + kOverread, kUnobserved);
}

}  // namespace roadfix
