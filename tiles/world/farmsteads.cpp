#include "tiles/world/farmsteads.hpp"

#include <cmath>

#include "tiles/world/corridor.hpp"
#include "tiles/world/palette.hpp"
#include "tiles/world/polygon.hpp"
#include "tiles/world/tracks.hpp"

namespace roadfix::world {
namespace {

constexpr double kFarmsteadsPerSquareKm = 16.0;

class Settler {
 public:
  Settler(Plan& plan, Random& random) : plan_(plan), random_(random), taken_(plan) {
    taken_.add(plan.streets, 3.0);
    taken_.add(plan.country.railway, 14.0);
    taken_.add(plan.river, plan.river_width_m * 1.5 + 4.0);
    for (const Polyline& pond : plan.country.ponds) taken_.add_area(pond);
  }

  void add_farm() {
    const Street& street = plan_.streets[random_.index(plan_.streets.size())];
    const std::size_t i = random_.index(street.line.size() - 1);
    const PlanPoint along = direction(street.line, i);
    const PlanPoint side = perpendicular(along) * (random_.chance(0.5) ? 1.0 : -1.0);
    const PlanPoint gate = street.line[i];
    const Footprint yard{gate + side * random_.uniform(24.0, 55.0),
                         std::atan2(along.y, along.x) + 0.15 * random_.normal(), random_.uniform(22.0, 46.0),
                         random_.uniform(16.0, 32.0)};
    if (!is_free(yard)) return;
    plan_.blocks.push_back({LandUse::kYard, yard.corners(), yard.length_m * yard.width_m});
    add_drive(gate, yard);
    taken_.add_area(yard.corners(-9.0));
    const int tries = random_.integer(4, 12);
    for (int k = 0; k < tries; ++k) add_building(yard);
  }

 private:
  bool is_free(const Footprint& footprint) const {
    Polyline rim = footprint.corners();
    rim.push_back(rim.front());
    const bool seen = footprint.centre.x > 0.0 && footprint.centre.y > 0.0 && footprint.centre.x < plan_.width_m &&
                      footprint.centre.y < plan_.height_m;
    return seen && taken_.share_of(rim) == 0.0 && !taken_.contains(footprint.centre);
  }

  void add_drive(PlanPoint gate, const Footprint& yard) {
    Street drive = unpaved(random_);
    drive.road_class = "service";
    if (random_.chance(0.3)) drive.surface = Surface::kAsphalt;
    const PlanPoint bend = (gate + yard.centre) / 2.0 + offset(3.0, 3.0, random_);
    for (int i = 0; i <= 8; ++i) {
      const double t = i / 8.0;
      drive.line.push_back(gate * ((1 - t) * (1 - t)) + bend * (2 * t * (1 - t)) + yard.centre * (t * t));
    }
    taken_.add(drive.line, drive.width_m + 1.0);
    plan_.streets.push_back(std::move(drive));
  }

  void add_building(const Footprint& yard) {
    const bool barn = random_.chance(0.5);
    const double side = yard.angle_rad + (random_.chance(0.5) ? 1.5707963 : 0.0);
    const double angle = side + 0.04 * random_.normal();
    const double across_m = random_.uniform(-0.8, 0.8) * yard.width_m;
    const Footprint footprint{yard.at(random_.uniform(-0.7, 0.7) * yard.length_m, across_m), angle,
                              barn ? random_.uniform(14.0, 34.0) : random_.uniform(8.0, 15.0),
                              barn ? random_.uniform(9.0, 15.0) : random_.uniform(7.0, 10.0)};
    if (!is_free(footprint)) return;
    taken_.add_area(footprint.corners(2.5));
    Building building{.footprint = footprint,
                      .height_m = barn ? random_.uniform(5.0, 9.0) : random_.uniform(4.0, 7.5),
                      .roof = barn ? Roof::kMetal : Roof::kHipped,
                      .detail_seed = random_.bits()};
    building.roof_colour = barn && random_.chance(0.6) ? palette::metal_roof(random_) : palette::tile_roof(random_);
    if (random_.chance(0.3)) building.roof_colour = palette::varied({96, 94, 96}, 0.15, random_);
    building.facade_colour = palette::facade(random_);
    building.lot_colour = random_.chance(0.5) ? plan_.country.grass : palette::lot(random_);
    plan_.buildings.push_back(building);
  }

  Plan& plan_;
  Random& random_;
  Corridor taken_;
};

void lay_bales(std::vector<Box>& boxes, const Parcel& parcel, Random& random) {
  const PlanPoint along(std::cos(parcel.row_angle_rad), std::sin(parcel.row_angle_rad));
  const PlanPoint side = perpendicular(along);
  const PlanPoint middle = middle_of(parcel.outline);
  const Colour colour = random.chance(0.5) ? Colour(206, 190, 148) : Colour(214, 218, 208);
  const double spacing = random.uniform(16.0, 30.0);
  const double reach = extent_along(parcel.outline, side) / 2.0;
  for (double across = -reach; across < reach; across += spacing) {
    for (const auto& [from, to] : stretches(parcel.outline, middle + side * across, along)) {
      walk({from, to}, random.uniform(4.0, spacing), spacing, [&](PlanPoint p, PlanPoint) {
        if (random.chance(0.7)) boxes.push_back({{p, random.uniform(0.0, 3.1), 1.5, 1.4}, 1.4, colour});
      });
    }
  }
}

}  // namespace

void settle(Plan& plan, Random& random) {
  if (plan.streets.empty()) return;
  Settler settler(plan, random);
  const int count = static_cast<int>(std::lround(plan.square_km() * kFarmsteadsPerSquareKm * random.uniform(0.3, 2.0)));
  for (int i = 0; i < count; ++i) settler.add_farm();
}

std::vector<Box> country_traffic(const Plan& plan, Random& random) {
  std::vector<Box> boxes;
  const auto put = [&](PlanPoint p, double angle) {
    const bool truck = random.chance(0.2);
    boxes.push_back({{p, angle + 0.05 * random.normal(), truck ? random.uniform(6.0, 11.0) : random.uniform(3.9, 4.9),
                      truck ? 2.4 : 1.8},
                     truck ? 3.0 : 1.5,
                     palette::car(random)});
  };
  for (const Street& street : plan.streets) {
    const bool paved = street.surface == Surface::kAsphalt;
    const double busy = paved ? 0.08 : 0.015;
    walk(street.line, random.uniform(2.0, 12.0), 12.0, [&](PlanPoint p, PlanPoint along) {
      const double lane = paved ? street.width_m * (random.chance(0.5) ? 0.23 : -0.23) : 0.0;
      if (random.chance(busy)) put(p + perpendicular(along) * lane, std::atan2(along.y, along.x));
    });
  }
  for (const Block& yard : plan.blocks) {
    const int count = random.integer(0, 4);
    for (int i = 0; i < count; ++i) {
      const PlanPoint off = offset(6.0, 5.0, random);
      put(middle_of(yard.outline) + off, random.uniform(0.0, 3.1));
    }
  }
  for (const Parcel& parcel : plan.country.parcels) {
    const bool mown = parcel.cover == Cover::kStubble || parcel.cover == Cover::kMeadow;
    if (mown && random.chance(0.12)) lay_bales(boxes, parcel, random);
  }
  return boxes;
}

}  // namespace roadfix::world
