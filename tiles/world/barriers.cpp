#include "tiles/world/barriers.hpp"

#include <cmath>
#include <numbers>

#include "tiles/world/corridor.hpp"
#include "tiles/world/palette.hpp"
#include "tiles/world/polygon.hpp"

namespace roadfix::world {
namespace {

constexpr double kProbeStepM = 6.0;
constexpr int kTries = 12;

/// Of a line across the whole picture that leaves its straight way by up to the sum of the amplitudes.
struct Course {
  double short_m = 0.0;
  double long_m = 0.0;
};

Polyline across(const Plan& plan, const Course& course, Random& random) {
  const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
  const PlanPoint along(std::cos(angle), std::sin(angle));
  const PlanPoint side = perpendicular(along);
  const PlanPoint through =
      any_point({0.15 * plan.width_m, 0.15 * plan.height_m, 0.7 * plan.width_m, 0.7 * plan.height_m}, random);
  const double reach = std::hypot(plan.width_m, plan.height_m);
  const double phase = random.uniform(0.0, 6.3);
  Polyline line;
  for (double t = -reach; t <= reach; t += kProbeStepM) {
    const double off = course.short_m * std::sin(t / 23.0 + phase) * std::sin(t / 61.0) +
                       course.long_m * std::sin(t / 110.0 + 2.0 * phase);
    line.push_back(through + along * t + side * off);
  }
  return line;
}

/// Of some lines the one that runs the least along roads.
Polyline clear_of(const Corridor& roads, const Plan& plan, const Course& course, Random& random) {
  Polyline best;
  double min = 2.0;
  for (int i = 0; i < kTries; ++i) {
    Polyline line = across(plan, course, random);
    const double share = roads.share_of(line);
    if (share < min) {
      min = share;
      best = std::move(line);
    }
  }
  return best;
}

void end_tracks_before(Plan& plan, const Corridor& barrier) {
  std::vector<Street> kept;
  for (Street& street : plan.streets) {
    if (street.surface == Surface::kAsphalt) {
      kept.push_back(std::move(street));
      continue;
    }
    for (Polyline& part : outside_of(barrier, street.line)) {
      if (length_m(part) < 20.0) continue;
      Street piece = street;
      piece.line = std::move(part);
      kept.push_back(std::move(piece));
    }
  }
  plan.streets = std::move(kept);
}

void dig_ponds(Plan& plan, Random& random) {
  Corridor roads(plan);
  roads.add(plan.streets, 8.0);
  roads.add(plan.country.railway, 16.0);
  const double expected = plan.square_km() * random.uniform(0.0, 6.0);
  const int count = static_cast<int>(expected + random.unit());
  for (int i = 0; i < count; ++i) {
    const PlanPoint at = any_point({0.0, 0.0, plan.width_m, plan.height_m}, random);
    Polyline pond = blob(at, random.uniform(6.0, 38.0), random);
    Polyline rim = pond;
    rim.push_back(pond.front());
    if (roads.share_of(rim) == 0.0 && !roads.contains(at)) plan.country.ponds.push_back(std::move(pond));
  }
}

}  // namespace

void lay_barriers(Plan& plan, Random& random) {
  Corridor roads(plan);
  roads.add(plan.streets, 6.0);
  Corridor barrier(plan);
  if (random.chance(0.4)) {
    plan.country.railway = clear_of(roads, plan, {0.0, random.uniform(0.0, 22.0)}, random);
    barrier.add(plan.country.railway, 9.0);
  }
  if (random.chance(0.6)) {
    plan.river_width_m = random.chance(0.6) ? random.uniform(2.0, 7.0) : random.uniform(8.0, 28.0);
    plan.river = clear_of(roads, plan, {random.uniform(3.0, 14.0), random.uniform(8.0, 40.0)}, random);
    barrier.add(plan.river, plan.river_width_m * 1.3 + 2.0);
  }
  plan.water = palette::varied(random.chance(0.6) ? Colour(62, 76, 70) : Colour(112, 108, 82), 0.2, random);
  end_tracks_before(plan, barrier);
  dig_ponds(plan, random);
}

}  // namespace roadfix::world
