#include "tiles/world/woods.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tiles/world/corridor.hpp"
#include "tiles/world/palette.hpp"
#include "tiles/world/polygon.hpp"

namespace roadfix::world {
namespace {

/// Trees that grow together.
struct Stand {
  Crown crown = Crown::kBroadleaf;
  double radius_m = 3.0;
  double slenderness = 4.0;  ///< height over radius
  Colour leaf{};
  bool deciduous = true;
};

Colour any_autumn(Random& random) {
  static const std::array<Colour, 5> kTones{
      {{150, 98, 50}, {164, 122, 56}, {132, 74, 50}, {120, 108, 62}, {172, 140, 74}}};
  return palette::varied(kTones[random.index(kTones.size())], 0.15, random);
}

class Forester {
 public:
  Forester(Plan& plan, Random& random)
      : plan_(plan),
        random_(random),
        conifers_(random.unit()),
        blocked_(plan),
        phase_{random.uniform(0.0, 6.3), random.uniform(0.0, 6.3)},
        closeness_(random.uniform(-0.8, 3.0)) {
    Corridor streets(plan);
    streets.add(plan.streets, 0.0);
    to_street_ = streets.distances();
    blocked_.add(plan.country.railway, 10.0);
    blocked_.add(plan.river, plan.river_width_m * 1.1);
    for (const Polyline& pond : plan.country.ponds) blocked_.add_area(pond);
    for (const Strip& strip : plan.country.strips) {
      if (strip.open) blocked_.add(strip.line, strip.width_m);
    }
    for (const Block& yard : plan.blocks) blocked_.add_area(yard.outline);
    for (const Building& building : plan.buildings) blocked_.add_area(building.footprint.corners(2.0));
  }

  void cover(const Parcel& parcel) {
    switch (parcel.cover) {
      case Cover::kWood:
        return wood(parcel);
      case Cover::kOrchard:
        return orchard(parcel);
      case Cover::kScrub: {
        const Stand stand = shrubs();
        return scatter(parcel, random_.uniform(14.0, 90.0), stand);
      }
      case Cover::kMeadow: {
        const Stand stand = any_stand();
        return scatter(parcel, random_.uniform(500.0, 4000.0), stand);
      }
      case Cover::kCrop:
      case Cover::kPlough:
      case Cover::kStubble:
        return scatter(parcel, 20'000.0, any_stand());
    }
  }

  void hedge(const Polyline& line) {
    Stand stand = shrubs();
    stand.radius_m *= 1.3;
    const Stand tall = any_stand();
    const double trees = random_.chance(0.5) ? random_.uniform(0.02, 0.5) : 0.0;
    const double gaps = random_.uniform(0.0, 0.3);
    walk(line, 0.0, stand.radius_m * 1.3, [&](PlanPoint p, PlanPoint along) {
      const PlanPoint at = p + perpendicular(along) * (0.4 * random_.normal());
      if (!random_.chance(gaps)) tree(random_.chance(trees) ? tall : stand, at);
    });
  }

  void beside(const Polyline& line, double off_m, double spacing_m, double share) {
    const Stand stand = any_stand();
    walk(line, random_.uniform(0.0, spacing_m), spacing_m, [&](PlanPoint p, PlanPoint along) {
      for (const double side : {-1.0, 1.0}) {
        const PlanPoint beside = p + perpendicular(along) * (side * (off_m + std::abs(random_.normal())));
        if (random_.chance(share)) tree(stand, beside);
      }
    });
  }

 private:
  Stand any_stand() {
    Stand stand;
    const bool conifer = random_.chance(conifers_);
    stand.crown = conifer ? Crown::kConifer : Crown::kBroadleaf;
    stand.deciduous = !conifer && random_.chance(0.85);
    stand.radius_m = conifer ? random_.uniform(1.3, 2.6) : random_.uniform(1.8, 4.6);
    stand.slenderness = conifer ? random_.uniform(5.0, 8.0) : random_.uniform(3.0, 5.0);
    const Colour leaf = plan_.country.grass * random_.uniform(0.42, 0.6) + Colour(12, 14, 10);
    stand.leaf = palette::varied(conifer ? leaf * 0.85 + Colour(0, 2, 6) : leaf, 0.18, random_);
    return stand;
  }

  Stand shrubs() {
    const Colour leaf = plan_.country.grass * 0.5 + Colour(10, 12, 8);
    return {Crown::kShrub, random_.uniform(0.7, 1.5), 1.2, palette::varied(leaf, 0.15, random_), random_.chance(0.5)};
  }

  /// How far crowns may reach over the rim of a street here, in metres; negative where they keep off.
  double overhang(PlanPoint p) const {
    const double wave = std::sin(p.x / 19.0 + std::sin(p.y / 31.0) + phase_.x) + std::sin(p.y / 23.0 + phase_.y);
    return closeness_ + 1.5 * wave + 0.4 * std::sin((p.x + p.y) / 7.0);
  }

  bool has_room(PlanPoint at, double radius) const {
    const double to_street = Corridor::at(to_street_, at);
    if (to_street < 0.4 || to_street - radius < -std::max(-1.5, overhang(at))) return false;
    return !blocked_.contains(at);
  }

  void tree(const Stand& stand, PlanPoint at) {
    const double radius = stand.radius_m * std::clamp(1.0 + 0.26 * random_.normal(), 0.5, 1.6);
    const double height = std::min(24.0, radius * stand.slenderness * random_.uniform(0.8, 1.2));
    const double tone = std::clamp(1.0 + 0.17 * random_.normal(), 0.6, 1.5);
    const Colour autumn = any_autumn(random_);
    if (!has_room(at, radius)) return;
    plan_.trees.push_back({at, radius, height, tone, stand.deciduous, stand.crown, stand.leaf, autumn});
  }

  void wood(const Parcel& parcel) {
    const Stand main = any_stand();
    const Stand other = any_stand();
    const double share = random_.chance(0.4) ? 0.0 : random_.uniform(0.05, 0.5);
    const double thinned = random_.chance(0.75) ? 0.03 : random_.uniform(0.05, 0.6);
    const double spacing = main.radius_m * random_.uniform(1.15, 1.5);
    const bool planted = main.crown == Crown::kConifer && random_.chance(0.35);
    rows(parcel, planted ? parcel.row_angle_rad : random_.uniform(0.0, 1.5), spacing, planted ? 0.1 : 0.42,
         [&](PlanPoint at) {
           if (!random_.chance(thinned)) tree(random_.chance(share) ? other : main, at);
         });
  }

  void orchard(const Parcel& parcel) {
    Stand stand = shrubs();
    stand.radius_m = random_.uniform(1.0, 2.4);
    rows(parcel, parcel.row_angle_rad, stand.radius_m * random_.uniform(2.3, 3.6), 0.06, [&](PlanPoint at) {
      if (random_.chance(0.94)) tree(stand, at);
    });
  }

  void scatter(const Parcel& parcel, double m2_each, const Stand& stand) {
    const cv::Rect2d box = box_of(parcel.outline);
    const std::vector<cv::Point2f> outline(parcel.outline.begin(), parcel.outline.end());
    const int count = static_cast<int>(box.area() / m2_each + random_.unit());
    for (int i = 0; i < count; ++i) {
      const PlanPoint at = any_point(box, random_);
      if (cv::pointPolygonTest(outline, at, false) > 0.0) tree(stand, at);
    }
  }

  /// Places in rows over the parcel; `jitter` is a share of the spacing.
  template <typename Visit>
  void rows(const Parcel& parcel, double angle, double spacing, double jitter, const Visit& visit) {
    const PlanPoint along(std::cos(angle), std::sin(angle));
    const PlanPoint side = perpendicular(along);
    const PlanPoint middle = middle_of(parcel.outline);
    const double reach = std::hypot(box_of(parcel.outline).width, box_of(parcel.outline).height);
    for (double across = -reach; across < reach; across += spacing) {
      for (const auto& [from, to] : stretches(parcel.outline, middle + side * across, along)) {
        walk({from, to}, random_.uniform(0.0, jitter > 0.2 ? spacing : 0.5), spacing,
             [&](PlanPoint p, PlanPoint) { visit(p + offset(spacing * jitter, spacing * jitter, random_)); });
      }
    }
  }

  Plan& plan_;
  Random& random_;
  double conifers_;
  Corridor blocked_;
  PlanPoint phase_;
  double closeness_;
  cv::Mat1f to_street_;
};

}  // namespace

void grow(Plan& plan, Random& random) {
  Forester forester(plan, random);
  for (const Parcel& parcel : plan.country.parcels) forester.cover(parcel);
  for (const Polyline& hedge : plan.country.hedges) forester.hedge(hedge);
  for (const Street& street : plan.streets) {
    if (random.chance(0.22)) forester.beside(street.line, street.width_m / 2.0 + 2.0, random.uniform(5.0, 12.0), 0.6);
  }
  if (!plan.river.empty()) forester.beside(plan.river, plan.river_width_m * 0.6 + 1.0, 4.0, random.uniform(0.1, 0.8));
  for (const Polyline& pond : plan.country.ponds) forester.beside(pond, 2.0, 5.0, random.uniform(0.0, 0.6));
  std::ranges::stable_sort(plan.trees, {}, &Tree::height_m);
}

}  // namespace roadfix::world
