#include "core/match/heading_bins.hpp"

#include <algorithm>
#include <cmath>

namespace roadfix {

HeadingBins HeadingBins::for_footprint(double radius_m, double cell_m) {
  const double half_turn = std::numbers::pi * std::max(radius_m, cell_m) / cell_m;
  return HeadingBins(2 * static_cast<int>(std::ceil(half_turn)));
}

int HeadingBins::nearest(Angle heading) const {
  return wrapped(static_cast<int>(std::lround(heading.radians() / step().radians())));
}

int HeadingBins::distance(int a, int b) const {
  const int apart = wrapped(a - b);
  return std::min(apart, count_ - apart);
}

}  // namespace roadfix
