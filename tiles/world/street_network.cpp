#include "tiles/world/street_network.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "tiles/world/distortion.hpp"
#include "tiles/world/polygon.hpp"

namespace roadfix::world {
namespace {

constexpr double kTau = 2.0 * std::numbers::pi;
constexpr double kPointEveryM = 12.0;
constexpr std::array<double, 6> kStreetWavesM{1700.0, 1100.0, 800.0, 520.0, 310.0, 190.0};
constexpr double kBending = 0.022;
constexpr double kCityRadiusShare = 0.62;  // of half the diagonal; beyond it lie fields

struct StreetClass {
  std::string name;
  double width_m;
};

const StreetClass& class_of(int level) {
  static const std::array<StreetClass, 5> kClasses{
      {{"primary", 15.0}, {"secondary", 11.0}, {"tertiary", 8.5}, {"residential", 6.5}, {"living_street", 5.0}}};
  return kClasses[static_cast<std::size_t>(std::clamp(level, 0, 4))];
}

class Layout {
 public:
  Layout(Plan& plan, Random& random) : plan_(plan), random_(random), bend_(random, kStreetWavesM, kBending) {}

  void build() {
    centre_ = {plan_.width_m * random_.uniform(0.4, 0.6), plan_.height_m * random_.uniform(0.4, 0.6)};
    lay_river();
    const double ring = std::min(plan_.width_m, plan_.height_m) * random_.uniform(0.2, 0.27);
    const double far = std::hypot(plan_.width_m, plan_.height_m) * 1.1;
    const int corners = random_.integer(6, 8);
    Polyline inner;
    Polyline outer;
    const double turn = random_.uniform(0.0, kTau);
    for (int i = 0; i < corners; ++i) {
      const double angle = turn + kTau * (i + random_.uniform(-0.22, 0.22)) / corners;
      const PlanPoint ray(std::cos(angle) * 1.15, std::sin(angle) * 0.9);
      inner.push_back(centre_ + ray * ring);
      outer.push_back(centre_ + ray * far);
    }
    for (std::size_t i = 0; i < inner.size(); ++i) {
      const std::size_t j = (i + 1) % inner.size();
      add({inner[i], inner[j]}, 0);
      add({inner[i], outer[i]}, i % 3 == 0 ? 0 : 1);
      split({inner[i], inner[j], outer[j], outer[i]}, 1);
    }
    split(inner, 1);
  }

 private:
  bool outside(const Polyline& polygon) const {
    constexpr double kMarginM = 150.0;
    const cv::Rect2d box = box_of(polygon);
    return box.br().x < -kMarginM || box.br().y < -kMarginM || box.x > plan_.width_m + kMarginM ||
           box.y > plan_.height_m + kMarginM;
  }

  /// Ground that is not split any further: small blocks in the middle, larger ones outwards, fields at the rim.
  double target_area(PlanPoint at) const {
    const double radius = kCityRadiusShare * std::hypot(plan_.width_m, plan_.height_m) / 2.0;
    const double distance = cv::norm(at - centre_) / radius;
    if (distance > 1.05) return 90'000.0;
    return 5'500.0 + 5'500.0 * distance;
  }

  void split(const Polyline& polygon, int level) {
    if (polygon.size() < 3 || outside(polygon)) return;
    const double area = area_of(polygon);
    const double target = target_area(middle_of(polygon)) * random_.uniform(0.6, 1.7);
    if (area < target) return;
    PlanPoint along = longest_side(polygon);
    const PlanPoint across = perpendicular(along);
    if (extent_along(polygon, across) > extent_along(polygon, along)) along = across;
    const double skew = random_.normal() * 0.09;
    const PlanPoint normal = perpendicular(along);
    const PlanPoint street = normal * std::cos(skew) + along * std::sin(skew);
    const double shift = extent_along(polygon, along) * random_.uniform(-0.17, 0.17);
    const Cut halves = cut(polygon, middle_of(polygon) + along * shift, street);
    if (halves.chord.size() != 2) return;
    add_street(halves.chord, level_of(area, level));
    for (const Polyline& part : halves.parts) split(part, level + 1);
  }

  int level_of(double area, int level) {
    if (area > 500'000.0) return std::min(level, 1);
    if (area > 120'000.0) return 2;
    return random_.chance(0.3) ? 4 : 3;
  }

  /// Some small streets end blind, a few are missing: a yard was built over them.
  void add_street(Polyline chord, int level) {
    if (level >= 3) {
      if (random_.chance(0.05)) return;
      if (random_.chance(0.12)) {
        const std::size_t blind = random_.index(2);
        chord[blind] = chord[1 - blind] + (chord[blind] - chord[1 - blind]) * random_.uniform(0.45, 0.75);
      }
    }
    add(chord, level);
  }

  void add(const Polyline& chord, int level) {
    const StreetClass& kind = class_of(level);
    const double width = kind.width_m * random_.uniform(0.88, 1.15);
    const double length = cv::norm(chord[1] - chord[0]);
    const int pieces = std::max(1, static_cast<int>(length / kPointEveryM));
    Street street{kind.name, std::round(width * 10.0) / 10.0, {}};
    for (int i = 0; i <= pieces; ++i) {
      const PlanPoint p = bend_(chord[0] + (chord[1] - chord[0]) * (static_cast<double>(i) / pieces));
      if (level >= 3 && in_river(p)) {
        keep(std::move(street));
        street = {kind.name, std::round(width * 10.0) / 10.0, {}};
      } else {
        street.line.push_back(p);
      }
    }
    keep(std::move(street));
  }

  void keep(Street street) {
    if (street.line.size() >= 2) plan_.streets.push_back(std::move(street));
  }

  void lay_river() {
    if (std::min(plan_.width_m, plan_.height_m) < 1000.0 || random_.chance(0.4)) return;
    plan_.river_width_m = random_.uniform(14.0, 30.0);
    const double angle = random_.uniform(0.0, kTau);
    const PlanPoint along(std::cos(angle), std::sin(angle));
    const double reach = std::hypot(plan_.width_m, plan_.height_m);
    const PlanPoint through = centre_ + perpendicular(along) * (reach * 0.2);
    for (double t = -reach; t <= reach; t += kPointEveryM) {
      const double meander = 30.0 * std::sin(t / 140.0) + 45.0 * std::sin(t / 333.0 + 1.0);
      plan_.river.push_back(bend_(through + along * t + perpendicular(along) * meander));
    }
  }

  bool in_river(PlanPoint p) const {
    return std::ranges::any_of(plan_.river,
                               [&](const PlanPoint& r) { return cv::norm(r - p) < plan_.river_width_m * 0.9 + 6.0; });
  }

  Plan& plan_;
  Random& random_;
  Distortion bend_;
  PlanPoint centre_;
};

}  // namespace

void invent_streets(Plan& plan, Random& random) {
  Layout(plan, random).build();
  sort_by_width(plan.streets);
}

void sort_by_width(std::vector<Street>& streets) { std::ranges::stable_sort(streets, {}, &Street::width_m); }

}  // namespace roadfix::world
