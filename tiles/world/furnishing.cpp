#include "tiles/world/furnishing.hpp"

#include <algorithm>
#include <cmath>

#include "tiles/world/palette.hpp"
#include "tiles/world/polygon.hpp"

namespace roadfix::world {
namespace {

/// Clumps of trees for each 1000 square metres.
double clumps_per_1000_m2(LandUse use) {
  switch (use) {
    case LandUse::kHouses:
      return 6.0;
    case LandUse::kApartments:
      return 4.5;
    case LandUse::kPark:
      return 3.0;
    case LandUse::kForest:
      return 13.0;
    case LandUse::kYard:
      return 1.2;
    case LandUse::kField:
      return 0.08;
    case LandUse::kVerge:
      return 3.0;
    case LandUse::kHalls:
    case LandUse::kWaste:
      return 0.8;
    case LandUse::kOrchard:
      return 0.0;
  }
  return 0.0;
}

class Gardener {
 public:
  Gardener(Plan& plan, const Site& site, Random& random) : plan_(plan), site_(site), random_(random) {}

  void tree(PlanPoint at, double radius) {
    plan_.trees.push_back(
        {at, radius, radius * random_.uniform(1.6, 2.6), random_.uniform(0.75, 1.3), random_.chance(0.3)});
  }

  void clumps(int number, const Block& block) {
    const cv::Rect2d box = box_of(block.outline);
    const int count = static_cast<int>(box.area() / 1000.0 * clumps_per_1000_m2(block.use) + random_.unit());
    for (int i = 0; i < count; ++i) {
      const PlanPoint at = any_point(box, random_);
      if (site_.block_at(at) == number) clump(number, at);
    }
  }

  void orchard(int number, const Block& block) {
    const cv::Rect2d box = box_of(block.outline);
    const double angle = random_.uniform(0.0, 1.57);
    const double spacing = random_.uniform(5.0, 8.5);
    const double reach = std::hypot(box.width, box.height) / 2.0;
    const Footprint grid{(box.tl() + box.br()) / 2.0, angle, 0.0, 0.0};
    for (double u = -reach; u < reach; u += spacing) {
      for (double v = -reach; v < reach; v += spacing) {
        const PlanPoint off = offset(0.4, 0.4, random_);
        const PlanPoint at = grid.at(u + off.x, v + off.y);
        if (random_.chance(0.92) && site_.block_at(at) == number) tree(at, random_.uniform(1.3, 2.3));
      }
    }
  }

  void avenue(const Street& street) {
    if (!random_.chance(street.width_m >= 8.0 ? 0.75 : 0.3)) return;
    const double spacing = random_.uniform(7.0, 11.0);
    for (const double side : {-1.0, 1.0}) {
      if (random_.chance(0.25)) continue;
      walk(street.line, spacing / 2.0, spacing, [&](PlanPoint p, PlanPoint along) {
        const PlanPoint beside = p + perpendicular(along) * (side * (street.width_m / 2.0 + 1.6));
        if (random_.chance(0.72) && !on_street(beside, street)) tree(beside, random_.uniform(1.3, 2.5));
      });
    }
  }

 private:
  void clump(int number, PlanPoint centre) {
    const int count = random_.integer(1, 5);
    for (int i = 0; i < count; ++i) {
      const PlanPoint at = centre + offset(3.0, 3.0, random_);
      if (site_.is_free(at) && site_.block_at(at) == number) tree(at, random_.uniform(1.4, 3.4));
    }
  }

  /// A tree must not stand in the mouth of a crossing street: there the ground a little further out is no block.
  bool on_street(PlanPoint beside, const Street& street) const {
    PlanPoint nearest = street.line.front();
    for (const PlanPoint& p : street.line) {
      if (cv::norm(p - beside) < cv::norm(nearest - beside)) nearest = p;
    }
    const PlanPoint outward = beside - nearest;
    const double length = std::max(cv::norm(outward), 0.1);
    return site_.block_at(beside + outward / length * 4.0) == 0;
  }

  Plan& plan_;
  const Site& site_;
  Random& random_;
};

}  // namespace

void plant(Plan& plan, const Site& site, Random& random) {
  Gardener gardener(plan, site, random);
  for (std::size_t i = 0; i < plan.blocks.size(); ++i) {
    const Block& block = plan.blocks[i];
    if (block.outline.size() < 3) continue;
    const int number = static_cast<int>(i) + 1;
    block.use == LandUse::kOrchard ? gardener.orchard(number, block) : gardener.clumps(number, block);
  }
  for (const Street& street : plan.streets) gardener.avenue(street);
}

std::vector<Box> traffic(const Plan& plan, Random& random) {
  std::vector<Box> cars;
  const auto put = [&](PlanPoint p, PlanPoint along, double across, bool bus) {
    const Footprint footprint{p + perpendicular(along) * across, std::atan2(along.y, along.x) + 0.04 * random.normal(),
                              bus ? 11.5 : random.uniform(3.9, 4.9), bus ? 2.6 : 1.85};
    cars.push_back({footprint, bus ? 3.0 : 1.5, palette::car(random)});
  };
  for (const Street& street : plan.streets) {
    const double busy = random.uniform(0.05, 0.3);
    const bool large = street.width_m >= 8.0;
    for (const double side : {-1.0, 1.0}) {
      walk(street.line, random.uniform(8.0, 14.0), 6.2, [&](PlanPoint p, PlanPoint along) {
        if (random.chance(busy)) put(p, along, side * (street.width_m / 2.0 - 1.2), false);
        if (large && random.chance(0.08)) put(p, along, side * street.width_m * 0.24, random.chance(0.06));
      });
    }
  }
  return cars;
}

}  // namespace roadfix::world
