#include "tiles/world/disaster.hpp"

#include <algorithm>
#include <cmath>

#include "tiles/world/furnishing.hpp"
#include "tiles/world/palette.hpp"
#include "tiles/world/polygon.hpp"

namespace roadfix::world {
namespace {

/// How hard the ground shook, about 1 on average, with patches of 100 to 300 m.
class Shaking {
 public:
  explicit Shaking(Random& random) : phase_{random.uniform(0.0, 6.3), random.uniform(0.0, 6.3)} {}
  double operator()(PlanPoint p) const {
    const double wave = std::sin(p.x / 47.0 + 1.7 * std::sin(p.y / 83.0 + phase_.y) + phase_.x) *
                        std::sin(p.y / 59.0 + 1.3 * std::sin(p.x / 71.0));
    return std::exp(2.2 * wave - 0.8);
  }

 private:
  PlanPoint phase_;
};

/// Numbers of the buildings that fall: exactly the share asked for, the weakest first.
std::vector<bool> fallen(const std::vector<Building>& buildings, double share, Random& random) {
  const Shaking shaking(random);
  std::vector<std::pair<double, std::size_t>> strength;
  for (std::size_t i = 0; i < buildings.size(); ++i) {
    const double weakness = shaking(buildings[i].footprint.centre) * (0.5 + buildings[i].height_m / 12.0);
    strength.emplace_back(-std::log(1.0 - random.unit()) / weakness, i);
  }
  std::ranges::sort(strength);
  std::vector<bool> result(buildings.size(), false);
  const auto count = static_cast<std::size_t>(std::lround(share * static_cast<double>(buildings.size())));
  for (std::size_t i = 0; i < count; ++i) result[strength[i].second] = true;
  return result;
}

void pitch_tents(Plan& plan, const Site& site, int number, const Block& block, Random& random) {
  const cv::Rect2d box = box_of(block.outline);
  const Footprint camp{
      {random.uniform(box.x, box.br().x), random.uniform(box.y, box.br().y)}, random.uniform(0.0, 3.1), 0.0, 0.0};
  const Colour cloth = random.chance(0.8) ? Colour(232, 230, 224) : Colour(120, 150, 190);
  const int along = random.integer(3, 8);
  const int across = random.integer(2, 6);
  for (int i = 0; i < along; ++i) {
    for (int j = 0; j < across; ++j) {
      const PlanPoint off = offset(0.4, 0.4, random);
      const PlanPoint at = camp.at(i * 7.5 + off.x, j * 9.5 + off.y);
      const Footprint tent{at, camp.angle_rad + 0.05 * random.normal(), 4.2, 5.6};
      if (random.chance(0.88) && site.has_room(tent, number)) {
        plan.boxes.push_back({tent, 2.2, palette::varied(cloth, 0.05, random)});
      }
    }
  }
}

}  // namespace

void collapse(Plan& plan, double share, Random& random) {
  const std::vector<Building> standing = std::move(plan.buildings);
  plan.buildings.clear();
  const std::vector<bool> falls = fallen(standing, share, random);
  for (std::size_t i = 0; i < falls.size(); ++i) {
    const Building& building = standing[i];
    if (!falls[i]) {
      plan.buildings.push_back(building);
      continue;
    }
    Footprint spread = building.footprint;
    const double spill = std::min(9.0, 0.35 * building.height_m) * random.uniform(0.5, 1.2);
    spread.length_m += spill;
    spread.width_m += spill;
    spread.centre += offset(spill * 0.25, spill * 0.25, random);
    spread.angle_rad += 0.1 * random.normal();
    plan.debris.push_back({spread, 1.0 + 0.16 * building.height_m, random.bits()});
  }
}

Plan after_earthquake(const Plan& before, const Site& site, double collapsed_share, Random& random) {
  Plan after = before;
  collapse(after, collapsed_share, random);
  std::erase_if(after.trees, [&](const Tree&) { return random.chance(0.07); });
  after.boxes = traffic(after, random);
  for (std::size_t i = 0; i < after.blocks.size(); ++i) {
    const Block& block = after.blocks[i];
    const bool open = block.use == LandUse::kPark || block.use == LandUse::kYard || block.use == LandUse::kWaste ||
                      (block.use == LandUse::kField && random.chance(0.3));
    const int camps = open ? random.integer(1, 3) : 0;
    for (int camp = 0; camp < camps; ++camp) pitch_tents(after, site, static_cast<int>(i) + 1, block, random);
  }
  return after;
}

}  // namespace roadfix::world
