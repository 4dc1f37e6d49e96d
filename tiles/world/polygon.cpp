#include "tiles/world/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace roadfix::world {
namespace {

/// Where the edge from `a` to `b` meets the line through `point`; nullopt if both ends lie on one side of it.
std::optional<PlanPoint> crossing(PlanPoint a, PlanPoint b, PlanPoint point, PlanPoint along) {
  const double side_a = along.cross(a - point);
  const double side_b = along.cross(b - point);
  if ((side_a < 0.0) == (side_b < 0.0)) return std::nullopt;
  return a + (b - a) * (side_a / (side_a - side_b));
}

}  // namespace

double area_of(const Polyline& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) twice += polygon[i].cross(polygon[(i + 1) % polygon.size()]);
  return std::abs(twice) / 2.0;
}

PlanPoint middle_of(const Polyline& polygon) {
  PlanPoint sum(0.0, 0.0);
  for (const PlanPoint& p : polygon) sum += p;
  return sum / static_cast<double>(polygon.size());
}

cv::Rect2d box_of(const Polyline& polygon) {
  const auto [west, east] = std::ranges::minmax(polygon, {}, &PlanPoint::x);
  const auto [north, south] = std::ranges::minmax(polygon, {}, &PlanPoint::y);
  return {west.x, north.y, east.x - west.x, south.y - north.y};
}

PlanPoint longest_side(const Polyline& polygon) {
  PlanPoint best(1.0, 0.0);
  double longest = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const PlanPoint side = polygon[(i + 1) % polygon.size()] - polygon[i];
    if (cv::norm(side) > longest) {
      longest = cv::norm(side);
      best = side / longest;
    }
  }
  return best;
}

double extent_along(const Polyline& polygon, PlanPoint along) {
  const auto [low, high] = std::ranges::minmax(polygon, {}, [&](const PlanPoint& p) { return p.dot(along); });
  return (high - low).dot(along);
}

Cut cut(const Polyline& polygon, PlanPoint point, PlanPoint along) {
  Cut result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const PlanPoint a = polygon[i];
    result.parts[along.cross(a - point) < 0.0 ? 1 : 0].push_back(a);
    if (const auto at = crossing(a, polygon[(i + 1) % polygon.size()], point, along)) {
      for (Polyline& part : result.parts) part.push_back(*at);
      result.chord.push_back(*at);
    }
  }
  return result;
}

std::vector<std::pair<PlanPoint, PlanPoint>> stretches(const Polyline& polygon, PlanPoint point, PlanPoint along) {
  std::vector<double> crossings;  // metres along the line
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const auto at = crossing(polygon[i], polygon[(i + 1) % polygon.size()], point, along);
    if (at) crossings.push_back((*at - point).dot(along));
  }
  std::ranges::sort(crossings);
  std::vector<std::pair<PlanPoint, PlanPoint>> result;
  for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
    result.emplace_back(point + along * crossings[i], point + along * crossings[i + 1]);
  }
  return result;
}

PlanPoint any_point(const cv::Rect2d& box, Random& random) {
  const double y = box.y + box.height * random.unit();
  return {box.x + box.width * random.unit(), y};
}

PlanPoint offset(double sigma_x_m, double sigma_y_m, Random& random) {
  const double y = sigma_y_m * random.normal();
  return {sigma_x_m * random.normal(), y};
}

Polyline blob(PlanPoint centre, double radius_m, Random& random) {
  constexpr int kCorners = 28;
  constexpr double kTau = 2.0 * std::numbers::pi;
  const double phase = random.uniform(0.0, kTau);
  const double oval = random.uniform(0.0, 0.28);
  const double uneven = random.uniform(0.05, 0.2);
  Polyline rim;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = kTau * i / kCorners;
    const double radius =
        radius_m * (1.0 + oval * std::sin(2.0 * angle + phase) + uneven * std::sin(3.0 * angle + 2.0 * phase));
    rim.push_back(centre + PlanPoint(std::cos(angle), std::sin(angle)) * radius);
  }
  return rim;
}

}  // namespace roadfix::world
