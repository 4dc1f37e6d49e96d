// Ground of the plane between four sides that are nearly straight, as those of a box of latitudes and longitudes are.
#pragma once

#include <array>

#include "core/units/planar.hpp"

namespace roadfix {

/// The parabola through three points: one coordinate of the plane over the other, which increases from point to point.
class GridSide {
 public:
  struct Point {
    double along_m;
    double at_m;
  };

  explicit GridSide(const std::array<Point, 3>& points);

  double at_m(double along_m) const {
    return first_.at_m + (along_m - first_.along_m) * (slope_ + bend_per_m_ * (along_m - second_along_m_));
  }
  /// Of the part from `low_m` to `high_m`.
  double lowest_m(double low_m, double high_m) const;
  double highest_m(double low_m, double high_m) const;
  /// Farther by that much, measured across.
  GridSide shifted(double by_m) const;

 private:
  /// Where it is lowest or highest of all, as far as that lies between the two.
  double turning_point_m(double low_m, double high_m) const;

  Point first_;
  double second_along_m_;
  double slope_;
  double bend_per_m_;
};

struct GridQuad {
  GridSide west;  ///< east over north
  GridSide east;
  GridSide south;  ///< north over east
  GridSide north;

  bool contains(GridPoint p) const {
    return p.east_m >= west.at_m(p.north_m) && p.east_m <= east.at_m(p.north_m) && p.north_m >= south.at_m(p.east_m) &&
           p.north_m <= north.at_m(p.east_m);
  }
  /// The part of the box that it reaches into; empty where they do not meet.
  GridBox within(const GridBox& box) const;
  /// And `by_m` on each side of it.
  GridQuad grown(double by_m) const;
};

}  // namespace roadfix
