#include "core/units/grid_quad.hpp"

#include <algorithm>
#include <cmath>

namespace roadfix {
namespace {

double slope_between(GridSide::Point a, GridSide::Point b) {
  return b.along_m > a.along_m ? (b.at_m - a.at_m) / (b.along_m - a.along_m) : 0.0;
}

}  // namespace

// Newton's form of the interpolation.
GridSide::GridSide(const std::array<Point, 3>& points)
    : first_(points[0]),
      second_along_m_(points[1].along_m),
      slope_(slope_between(points[0], points[1])),
      bend_per_m_(
          slope_between({points[0].along_m, slope_}, {points[2].along_m, slope_between(points[1], points[2])})) {}

double GridSide::turning_point_m(double low_m, double high_m) const {
  if (bend_per_m_ == 0.0) return low_m;
  return std::clamp(0.5 * (first_.along_m + second_along_m_ - slope_ / bend_per_m_), low_m, high_m);
}

double GridSide::lowest_m(double low_m, double high_m) const {
  return std::min({at_m(low_m), at_m(turning_point_m(low_m, high_m)), at_m(high_m)});
}

double GridSide::highest_m(double low_m, double high_m) const {
  return std::max({at_m(low_m), at_m(turning_point_m(low_m, high_m)), at_m(high_m)});
}

GridSide GridSide::shifted(double by_m) const {
  GridSide result = *this;
  result.first_.at_m += by_m * std::hypot(1.0, slope_);
  return result;
}

GridBox GridQuad::within(const GridBox& box) const {
  constexpr int kRounds = 4;  // each side bounds those beside it, the sides lean by some hundredths
  GridBox result = box;
  for (int i = 0; i < kRounds && !result.empty(); ++i) {
    auto& [min, max] = result;
    min.north_m = std::max(min.north_m, south.lowest_m(min.east_m, max.east_m));
    max.north_m = std::min(max.north_m, north.highest_m(min.east_m, max.east_m));
    if (result.empty()) break;
    min.east_m = std::max(min.east_m, west.lowest_m(min.north_m, max.north_m));
    max.east_m = std::min(max.east_m, east.highest_m(min.north_m, max.north_m));
  }
  return result;
}

GridQuad GridQuad::grown(double by_m) const {
  return {west.shifted(-by_m), east.shifted(by_m), south.shifted(-by_m), north.shifted(by_m)};
}

}  // namespace roadfix
