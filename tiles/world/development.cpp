#include "tiles/world/development.hpp"

#include <cmath>

#include "tiles/world/palette.hpp"
#include "tiles/world/polygon.hpp"

namespace roadfix::world {
namespace {

/// How buildings of a block look; ranges in metres.
struct Habit {
  double front_min, front_max;
  double depth_min, depth_max;
  double height_min, height_max;
  double setback_min, setback_max;
  double closed_share;  ///< of neighbours that touch
  double empty_share;   ///< of lots without a building
  int rows;
};

Habit habit_of(LandUse use) {
  switch (use) {
    case LandUse::kApartments:
      return {16.0, 34.0, 12.0, 18.0, 12.0, 27.0, 3.0, 7.0, 0.25, 0.12, 2};
    case LandUse::kHalls:
      return {24.0, 60.0, 18.0, 38.0, 5.0, 9.0, 4.0, 12.0, 0.1, 0.25, 1};
    case LandUse::kYard:
      return {22.0, 44.0, 12.0, 16.0, 7.0, 13.0, 6.0, 12.0, 0.0, 0.72, 1};
    case LandUse::kField:
      return {9.0, 15.0, 8.0, 11.0, 3.0, 6.0, 4.0, 12.0, 0.0, 0.93, 1};
    default:
      return {8.0, 15.0, 8.0, 12.5, 3.5, 10.5, 0.3, 2.5, 0.55, 0.09, 3};
  }
}

/// Smooth differences between districts, in [-1, 1].
class Districts {
 public:
  explicit Districts(Random& random) : phase_{random.uniform(0.0, 6.3), random.uniform(0.0, 6.3)} {}
  double operator()(PlanPoint p) const {
    return 0.5 * (std::sin(p.x / 190.0 + 0.8 * std::sin(p.y / 260.0) + phase_.x) + std::sin(p.y / 210.0 + phase_.y));
  }

 private:
  PlanPoint phase_;
};

LandUse use_of(const Block& block, double district, Random& random) {
  constexpr double kHectare = 10'000.0;
  if (block.area_m2 < 350.0) return LandUse::kVerge;
  const double draw = random.unit();
  if (block.area_m2 > 4.5 * kHectare) {
    if (draw < 0.68) return LandUse::kField;
    return draw < 0.85 ? LandUse::kOrchard : LandUse::kForest;
  }
  if (block.area_m2 > 1.6 * kHectare && draw < 0.4) {
    if (draw < 0.12) return LandUse::kPark;
    if (draw < 0.22) return LandUse::kYard;
    return draw < 0.32 ? LandUse::kHalls : LandUse::kOrchard;
  }
  if (draw < 0.035) return LandUse::kPark;
  if (draw < 0.075) return LandUse::kWaste;
  if (draw < 0.11) return LandUse::kYard;
  if (district > 0.45) return random.chance(0.8) ? LandUse::kApartments : LandUse::kHouses;
  if (district < -0.75) return random.chance(0.6) ? LandUse::kHalls : LandUse::kHouses;
  return random.chance(0.12) ? LandUse::kApartments : LandUse::kHouses;
}

Building design(LandUse use, const Footprint& footprint, double height_m, Random& random) {
  Building building{.footprint = footprint, .height_m = height_m, .detail_seed = random.bits()};
  const double draw = random.unit();
  if (use == LandUse::kHalls) {
    building.roof = draw < 0.8 ? Roof::kMetal : Roof::kFlat;
  } else if (draw < (use == LandUse::kHouses ? 0.14 : 0.24)) {
    building.roof = Roof::kHipped;
  }
  switch (building.roof) {
    case Roof::kFlat:
      building.roof_colour = palette::flat_roof(random);
      break;
    case Roof::kHipped:
      building.roof_colour = palette::tile_roof(random);
      break;
    case Roof::kMetal:
      building.roof_colour = palette::metal_roof(random);
      break;
  }
  building.facade_colour = palette::facade(random);
  building.lot_colour = palette::lot(random);
  return building;
}

class Builder {
 public:
  Builder(Plan& plan, Site& site, Random& random) : plan_(plan), site_(site), random_(random) {}

  void build(int number, const Block& block) {
    const Habit habit = habit_of(block.use);
    double offset = random_.uniform(habit.setback_min, habit.setback_max);
    for (int row = 0; row < habit.rows; ++row) {
      const double depth = random_.uniform(habit.depth_min, habit.depth_max);
      for (std::size_t i = 0; i < block.outline.size(); ++i) {
        line_edge(number, block, habit, block.outline[i], block.outline[(i + 1) % block.outline.size()], offset, depth);
      }
      offset += depth + random_.uniform(2.0, 7.0);
    }
  }

 private:
  void line_edge(int number, const Block& block, const Habit& habit, PlanPoint from, PlanPoint to, double offset,
                 double depth) {
    const double length = cv::norm(to - from);
    if (length < habit.front_min) return;
    const PlanPoint along = (to - from) / length;
    PlanPoint inward = perpendicular(along);
    if (site_.block_at((from + to) / 2.0 + inward * 2.5) != number) inward = -inward;
    for (double t = offset * 0.5; t < length;) {
      const double front = random_.uniform(habit.front_min, habit.front_max);
      const double deep = depth * random_.uniform(0.88, 1.08);
      const PlanPoint centre = from + along * (t + front / 2.0) + inward * (offset + deep / 2.0);
      const Footprint footprint{centre, std::atan2(along.y, along.x), front, deep};
      if (t + front > length || !site_.has_room(footprint, number)) {
        t += 2.0;
        continue;
      }
      if (!random_.chance(habit.empty_share)) {
        site_.occupy(footprint);
        const double height = random_.uniform(habit.height_min, habit.height_max);
        plan_.buildings.push_back(design(block.use, footprint, height, random_));
      }
      t += front + (random_.chance(habit.closed_share) ? 0.4 : random_.uniform(2.0, 6.5));
    }
  }

  Plan& plan_;
  Site& site_;
  Random& random_;
};

}  // namespace

void develop(Plan& plan, Site& site, Random& random) {
  const Districts districts(random);
  plan.blocks = site.blocks();
  Builder builder(plan, site, random);
  for (std::size_t i = 0; i < plan.blocks.size(); ++i) {
    Block& block = plan.blocks[i];
    if (block.outline.size() < 3) continue;
    block.use = use_of(block, districts(middle_of(block.outline)), random);
    const bool built = block.use == LandUse::kHouses || block.use == LandUse::kApartments ||
                       block.use == LandUse::kHalls || block.use == LandUse::kYard || block.use == LandUse::kField;
    if (built) builder.build(static_cast<int>(i) + 1, block);
  }
}

}  // namespace roadfix::world
