// Polygons of a plan, in its metres: how large they are, how a line cuts them. They are closed without repeating their
// first corner, run either way round, and have at least one corner.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "tiles/world/plan.hpp"
#include "tiles/world/random.hpp"

namespace roadfix::world {

/// Square metres.
double area_of(const Polyline& polygon);
/// The mean of the corners, which need not lie within.
PlanPoint middle_of(const Polyline& polygon);
cv::Rect2d box_of(const Polyline& polygon);
/// Unit direction of the longest side; east where none has a length.
PlanPoint longest_side(const Polyline& polygon);
/// Metres from the first to the last corner met in a unit direction.
double extent_along(const Polyline& polygon, PlanPoint along);

struct Cut {
  std::array<Polyline, 2> parts;
  Polyline chord;  ///< two points, where the line meets a convex polygon
};

/// Splits a convex polygon along the line through `point` with the unit direction `along`.
Cut cut(const Polyline& polygon, PlanPoint point, PlanPoint along);

/// Pieces of that line that lie in the polygon, which need not be convex.
std::vector<std::pair<PlanPoint, PlanPoint>> stretches(const Polyline& polygon, PlanPoint point, PlanPoint along);

/// Uniform over the box.
PlanPoint any_point(const cv::Rect2d& box, Random& random);
/// Normally distributed around 0 with these standard deviations.
PlanPoint offset(double sigma_x_m, double sigma_y_m, Random& random);
/// A round shape with an uneven rim.
Polyline blob(PlanPoint centre, double radius_m, Random& random);

}  // namespace roadfix::world
