// Points and poses on a metric plane: x east, y north, metres. Knows no Earth and no map;
// core/geodesy ties the plane to a UTM zone.
#pragma once

#include <array>
#include <limits>
#include <span>

#include "core/units/angle.hpp"

namespace roadfix {

struct GridPoint {
  double east_m = 0.0;
  double north_m = 0.0;
  friend bool operator==(const GridPoint&, const GridPoint&) = default;
};

/// Heading is clockwise from *grid* north; the API speaks of true north (see UtmZone::convergence).
struct GridPose {
  GridPoint position;
  Angle heading;
};

/// Covariance of east (m), north (m) and heading (rad, clockwise) about a pose.
using PoseCovariance = std::array<std::array<double, 3>, 3>;

/// Of the position along the longer axis of its ellipse, m^2; of what lies ahead and to the right likewise.
double largest_variance_m2(const PoseCovariance& covariance);

/// Where one pose of a body is, seen from another: so far ahead of it and to its right, turned so far clockwise.
struct BodyOffset {
  double forward_m = 0.0;
  double right_m = 0.0;
  Angle turn;
  friend bool operator==(const BodyOffset&, const BodyOffset&) = default;
};

struct GridCircle {
  GridPoint centre;
  double radius_m = 0.0;
};

/// Axis-aligned rectangle, closed; empty when min > max on an axis.
struct GridBox {
  GridPoint min;
  GridPoint max;
  double width_m() const { return max.east_m - min.east_m; }
  double height_m() const { return max.north_m - min.north_m; }
  GridPoint centre() const { return {0.5 * (min.east_m + max.east_m), 0.5 * (min.north_m + max.north_m)}; }
  bool empty() const { return min.east_m > max.east_m || min.north_m > max.north_m; }
  bool contains(GridPoint p) const {
    return p.east_m >= min.east_m && p.east_m <= max.east_m && p.north_m >= min.north_m && p.north_m <= max.north_m;
  }
  /// Whether they share more than a rim.
  bool overlaps(const GridBox& other) const {
    return min.east_m < other.max.east_m && other.min.east_m < max.east_m && min.north_m < other.max.north_m &&
           other.min.north_m < max.north_m;
  }
};

/// The empty box that united() leaves out.
inline constexpr GridBox kEmptyBox{
    {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()},
    {-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}};

/// The smallest box that holds both; neither is empty, other than kEmptyBox.
GridBox united(const GridBox& a, const GridBox& b);
/// The same of all of them; kEmptyBox of none.
GridBox united(std::span<const GridBox> boxes);

/// The smallest box that holds them; kEmptyBox of none.
GridBox box_around(std::span<const GridPoint> points);

/// What both hold; empty where they do not meet.
GridBox intersection(const GridBox& a, const GridBox& b);

/// The box and `by_m` on each side of it.
GridBox grown(const GridBox& box, double by_m);

/// The point of the box, which is not empty, that lies nearest to the point.
GridPoint nearest(const GridBox& box, GridPoint point);

double distance_m(GridPoint a, GridPoint b);
/// How far away the other pose is.
double distance_m(const BodyOffset& offset);

/// Whether the closed disc holds the point.
bool contains(const GridCircle& circle, GridPoint point);

/// The pose at that offset from `reference`, its heading in (-180, 180] degrees.
GridPose moved(const GridPose& reference, const BodyOffset& by);

/// Where `pose` is, seen from `reference`: moved() undone.
BodyOffset offset_from(const GridPose& reference, const GridPose& pose);

}  // namespace roadfix
