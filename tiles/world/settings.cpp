#include "tiles/world/settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/units/error.hpp"

namespace roadfix::world {
namespace {

constexpr double kMinSizeM = 200.0;
constexpr double kMaxSizeM = 8000.0;
constexpr double kMinGsdM = 0.25;
constexpr double kMaxGsdM = 2.0;
constexpr int kMaxFrames = 10'000;
constexpr double kMinFootprintM = 20.0;

bool within(double value, double low, double high) { return value >= low && value <= high; }

}  // namespace

void check(const WorldSettings& s) {
  if (!within(s.width_m, kMinSizeM, kMaxSizeM) || !within(s.height_m, kMinSizeM, kMaxSizeM)) {
    throw InvalidInput("parameter-out-of-range",
                       fmt::format("a world of {:g} x {:g} km cannot be rendered: choose {:g} to {:g} km",
                                   s.width_m / 1000.0, s.height_m / 1000.0, kMinSizeM / 1000.0, kMaxSizeM / 1000.0));
  }
  if (!within(s.gsd_m, kMinGsdM, kMaxGsdM)) {
    throw InvalidInput(
        "parameter-out-of-range",
        fmt::format("pixels of {:g} m cannot be rendered: choose {:g} to {:g} m", s.gsd_m, kMinGsdM, kMaxGsdM));
  }
  if (s.land == Land::kCountry && !s.roads.empty()) {
    throw InvalidInput("world-land-roads",
                       fmt::format("{}: given roads can only be rendered as a town's: leave out the "
                                   "roads, or choose the land town",
                                   s.roads));
  }
  if (!within(s.collapsed_share, 0.0, 1.0)) {
    throw InvalidInput(
        "parameter-out-of-range",
        fmt::format("a share of {:g} of the buildings cannot collapse: choose 0 to 1", s.collapsed_share));
  }
  if (s.frames < 0 || s.frames > kMaxFrames || !within(s.footprint_m, kMinFootprintM, kMaxSizeM)) {
    throw InvalidInput("parameter-out-of-range",
                       fmt::format("{} frames of {:g} m cannot be cut: choose 0 to {} frames of {:g} to "
                                   "{:g} m",
                                   s.frames, s.footprint_m, kMaxFrames, kMinFootprintM, kMaxSizeM));
  }
  const double across = s.footprint_m * std::numbers::sqrt2 + 2.0 * s.gsd_m;
  if (s.frames > 0 && across > std::min(s.width_m, s.height_m)) {
    throw InvalidInput("world-too-small-for-frames",
                       fmt::format("a frame of {:g} x {:g} m turned by 45 degrees is {:.0f} m across and does not fit "
                                   "into {:g} x {:g} m: choose a larger world or smaller frames",
                                   s.footprint_m, s.footprint_m, across, s.width_m, s.height_m));
  }
}

Placement place(const WorldSettings& settings, LatLon centre) {
  const UtmZone zone = UtmZone::containing(centre);
  const GridPoint middle = zone.project(centre);
  const int cols = static_cast<int>(std::lround(settings.width_m / settings.gsd_m));
  const int rows = static_cast<int>(std::lround(settings.height_m / settings.gsd_m));
  const auto snapped = [&](double value) { return std::round(value / settings.gsd_m) * settings.gsd_m; };
  return {
      zone,
      settings.gsd_m,
      cols,
      rows,
      {snapped(middle.east_m - cols * settings.gsd_m / 2.0), snapped(middle.north_m + rows * settings.gsd_m / 2.0)}};
}

}  // namespace roadfix::world
