#include "tiles/world/tracks.hpp"

#include <array>
#include <cmath>
#include <optional>

#include "tiles/world/corridor.hpp"

namespace roadfix::world {
namespace {

constexpr double kStepM = 5.0;
constexpr double kLeavingM = 22.0;  // within which a track may still touch the street that it leaves
constexpr double kTracksPerSquareKm = 26.0;

struct Start {
  PlanPoint at;
  PlanPoint along;
};

/// The nearest point of any street within the reach.
std::optional<PlanPoint> nearest(const std::vector<Street>& streets, PlanPoint p, double reach_m) {
  std::optional<PlanPoint> best;
  for (const Street& street : streets) {
    for (const PlanPoint& q : street.line) {
      if (cv::norm(q - p) < reach_m) {
        reach_m = cv::norm(q - p);
        best = q;
      }
    }
  }
  return best;
}

class Wanderer {
 public:
  Wanderer(Plan& plan, Random& random) : plan_(plan), random_(random), streets_(plan), barriers_(plan) {
    streets_.add(plan.streets, 4.0);
    barriers_.add(plan.country.railway, 9.0);
    barriers_.add(plan.river, plan.river_width_m * 1.3 + 2.0);
    for (const Polyline& pond : plan.country.ponds) barriers_.add_area(pond);
  }

  void add_track() {
    Street track = unpaved(random_);
    const double winding = random_.uniform(0.2, 1.0);
    track.line = way(winding);
    const double length = length_m(track.line);
    if (length < 35.0 || streets_.share_of(track.line) > 16.0 / length + 0.1) return;
    streets_.add(track.line, track.width_m + 4.0);
    plan_.streets.push_back(std::move(track));
  }

 private:
  Start start() {
    const Street& street = plan_.streets[random_.index(plan_.streets.size())];
    const std::size_t i = random_.index(street.line.size() - 1);
    return {street.line[i], direction(street.line, i)};
  }

  Polyline way(double winding) {
    const Start from = start();
    const double side = random_.chance(0.5) ? 1.0 : -1.0;
    double heading = std::atan2(from.along.y, from.along.x) + side * random_.uniform(0.9, 2.2);
    double turn = 0.0;
    const double length = random_.uniform(50.0, 480.0);
    Polyline line{from.at};
    for (double gone = 0.0; gone < length; gone += kStepM) {
      turn = 0.75 * turn + 0.11 * winding * random_.normal();
      heading += turn;
      const PlanPoint next = line.back() + PlanPoint(std::cos(heading), std::sin(heading)) * kStepM;
      if (barriers_.contains(next) || beyond(next)) break;
      line.push_back(next);
      if (gone > kLeavingM && streets_.contains(next)) {
        if (const auto end = nearest(plan_.streets, next, 10.0)) line.push_back(*end);
        break;
      }
    }
    return line;
  }

  bool beyond(PlanPoint p) const {
    constexpr double kRoom = Corridor::kMarginM;
    return p.x < -kRoom || p.y < -kRoom || p.x > plan_.width_m + kRoom || p.y > plan_.height_m + kRoom;
  }

  Plan& plan_;
  Random& random_;
  Corridor streets_;
  Corridor barriers_;
};

}  // namespace

Street unpaved(Random& random) {
  static const std::array<Surface, 6> kSurfaces{Surface::kGravel, Surface::kGravel, Surface::kEarth,
                                                Surface::kEarth,  Surface::kEarth,  Surface::kSand};
  Street track{.road_class = "track", .line = {}};
  track.width_m = std::round(random.uniform(2.5, 4.0) * 10.0) / 10.0;
  track.surface = kSurfaces[random.index(kSurfaces.size())];
  track.grass_strip = track.width_m < 3.5 && random.chance(0.4);
  track.wear = random.uniform(0.4, 1.0);
  return track;
}

void wander(Plan& plan, Random& random) {
  if (plan.streets.empty()) return;
  Wanderer wanderer(plan, random);
  const int count = static_cast<int>(std::lround(plan.square_km() * kTracksPerSquareKm * random.uniform(0.5, 1.5)));
  for (int i = 0; i < count; ++i) wanderer.add_track();
}

}  // namespace roadfix::world
