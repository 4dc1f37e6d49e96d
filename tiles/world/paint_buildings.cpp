#include "tiles/world/paint_buildings.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "tiles/world/palette.hpp"
#include "tiles/world/polygon.hpp"
#include "tiles/world/random.hpp"

namespace roadfix::world {
namespace {

constexpr double kRoofSlope = 0.5;  // rise over run of tiled roofs

/// Brightness of a surface that rises towards `uphill` with the slope, against level ground.
double lit(PlanPoint uphill, double slope, const Conditions& conditions) {
  const PlanPoint to_sun = -conditions.shadow_direction();
  const double flat = std::sin(conditions.sun_elevation.radians());
  const double level = std::cos(conditions.sun_elevation.radians());
  const double tilted = (flat - slope * uphill.dot(to_sun) * level) / std::hypot(1.0, slope);
  return std::clamp(0.45 + 0.55 * tilted / flat, 0.4, 1.45);
}

class BuildingPainter {
 public:
  BuildingPainter(Canvas& canvas, const Conditions& conditions, const Building& building)
      : canvas_(canvas), conditions_(conditions), building_(building), random_(building.detail_seed, 7) {
    roof_ = building.footprint;
    roof_.centre += conditions.lean * building.height_m;
  }

  void paint() {
    paint_facades();
    switch (building_.roof) {
      case Roof::kFlat:
        paint_flat();
        break;
      case Roof::kHipped:
        paint_hipped();
        break;
      case Roof::kMetal:
        paint_metal();
        break;
    }
  }

 private:
  Colour dusty(const Colour& c) const { return palette::mixed(c, palette::kDust, conditions_.dust * 0.45); }

  /// Walls between the footprint and the roof above it, those that the camera sees and those that the roof will hide.
  void paint_facades() {
    const Polyline foot = building_.footprint.corners();
    const Polyline top = roof_.corners();
    const PlanPoint to_sun = -conditions_.shadow_direction();
    for (std::size_t i = 0; i < foot.size(); ++i) {
      const std::size_t j = (i + 1) % foot.size();
      const PlanPoint wall = (foot[j] - foot[i]) / std::max(cv::norm(foot[j] - foot[i]), 0.01);
      const PlanPoint outward(wall.y, -wall.x);
      const double light = 0.5 + 0.55 * std::max(0.0, outward.dot(to_sun));
      canvas_.fill({foot[i], foot[j], top[j], top[i]}, dusty(building_.facade_colour) * light, Material::kSmooth,
                   building_.height_m * 0.6);
    }
  }

  void detail(double along, double across, double length, double width, const Colour& colour, double height) {
    const Footprint part{roof_.at(along, across), roof_.angle_rad, length, width};
    canvas_.fill(part.corners(), dusty(colour), Material::kSmooth, building_.height_m + height);
  }

  void paint_flat() {
    const Colour colour = dusty(building_.roof_colour);
    canvas_.fill(roof_.corners(), colour * 1.07, Material::kRoof, building_.height_m + 0.7);
    canvas_.fill(roof_.corners(-0.45), colour * 0.97, Material::kRoof, building_.height_m);
    const double a = roof_.length_m / 2.0 - 1.2;
    const double b = roof_.width_m / 2.0 - 1.2;
    if (random_.chance(0.6)) {  // a part that was sealed anew
      const double share = random_.uniform(0.3, 0.6);
      const Colour tone = building_.roof_colour * random_.uniform(0.82, 1.12);
      const double end = random_.chance(0.5) ? a : -a;
      detail(end * (1.0 - share), 0.0, 2.0 * a * share, 2.0 * b, tone, 0.0);
    }
    const int heads = random_.integer(1, building_.footprint.length_m > 18.0 ? 3 : 1);
    for (int i = 0; i < heads; ++i) {  // stairs and lifts
      const Colour tone = building_.roof_colour * random_.uniform(0.9, 1.1);
      const double width_m = random_.uniform(2.0, 3.2);
      const double length_m = random_.uniform(2.2, 4.0);
      const PlanPoint at = any_point({-0.7 * a, -0.6 * b, 1.4 * a, 1.2 * b}, random_);
      detail(at.x, at.y, length_m, width_m, tone, 2.4);
    }
    const int heaters = random_.integer(0, static_cast<int>(roof_.length_m * roof_.width_m / 28.0));
    for (int i = 0; i < heaters; ++i) {  // solar water heaters: a dark panel, a white tank
      const double u = random_.uniform(-a, a);
      const double v = random_.uniform(-b, b);
      detail(u, v, 1.9, 1.1, {70, 76, 90}, 0.9);
      detail(u, v - 0.9, 1.6, 0.7, {236, 236, 232}, 1.2);
    }
  }

  void paint_hipped() {
    const double half_a = std::max(roof_.length_m, roof_.width_m) / 2.0;
    const double half_b = std::min(roof_.length_m, roof_.width_m) / 2.0;
    Footprint f = roof_;
    if (roof_.width_m > roof_.length_m) {
      f.angle_rad += 1.5707963267948966;
      std::swap(f.length_m, f.width_m);
    }
    const double rise = half_b * kRoofSlope;
    const PlanPoint lift = conditions_.lean * rise;
    const double ridge = half_a - half_b * 0.9;
    const std::array<PlanPoint, 2> top{f.at(-ridge, 0.0) + lift, f.at(ridge, 0.0) + lift};
    const Polyline c = f.corners(0.3);
    const PlanPoint along(std::cos(f.angle_rad), std::sin(f.angle_rad));
    const PlanPoint across = perpendicular(along);
    const auto face = [&](const Polyline& polygon, PlanPoint uphill) {
      const Colour colour = dusty(building_.roof_colour) * lit(uphill, kRoofSlope, conditions_);
      canvas_.fill(polygon, colour, Material::kRoof, building_.height_m + rise * 0.5);
    };
    face({c[0], c[1], top[1], top[0]}, across);
    face({c[2], c[3], top[0], top[1]}, -across);
    face({c[1], c[2], top[1]}, -along);
    face({c[3], c[0], top[0]}, along);
    canvas_.stroke({top[0], top[1]}, 0.5, dusty(building_.roof_colour) * 1.12, Material::kRoof);
  }

  void paint_metal() {
    const Colour colour = dusty(building_.roof_colour);
    const double slope = 0.15;
    const PlanPoint along(std::cos(roof_.angle_rad), std::sin(roof_.angle_rad));
    const PlanPoint across = perpendicular(along);
    for (const double side : {-1.0, 1.0}) {
      const Footprint half{roof_.at(0.0, side * roof_.width_m / 4.0), roof_.angle_rad, roof_.length_m,
                           roof_.width_m / 2.0};
      canvas_.fill(half.corners(), colour * lit(across * -side, slope, conditions_), Material::kSmooth,
                   building_.height_m);
    }
    for (double u = -roof_.length_m / 2.0 + 3.0; u < roof_.length_m / 2.0; u += 6.0) {
      canvas_.stroke({roof_.at(u, -roof_.width_m / 2.0), roof_.at(u, roof_.width_m / 2.0)}, 0.4, colour * 0.93,
                     Material::kSmooth);
    }
  }

  Canvas& canvas_;
  const Conditions& conditions_;
  const Building& building_;
  Random random_;
  Footprint roof_;
};

}  // namespace

void paint_buildings(Canvas& canvas, const Plan& plan, const Conditions& conditions) {
  for (const Building& building : plan.buildings) {
    const double reach = building.footprint.radius_m() + building.height_m;
    if (canvas.sees(building.footprint.centre, reach)) BuildingPainter(canvas, conditions, building).paint();
  }
}

}  // namespace roadfix::world
