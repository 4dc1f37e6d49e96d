#include "core/track/tracker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/locate/prepare.hpp"
#include "core/match/scales.hpp"
#include "core/track/track_geometry.hpp"
#include "core/track/track_search.hpp"
#include "core/track/tracker_step.hpp"
#include "core/units/error.hpp"

namespace roadfix {
namespace {

AcceptanceRegion region_of_flight(const MapView& map, const TrackSettings& settings) {
  require_scale_range(settings.vehicle.scale_range);
  return {region_of(map, {}), settings.beyond_map_m, max_log_scale(settings.vehicle.scale_range)};
}

void require_in_order(const TrackerState& before, const StepInput& step) {
  if (!before.last) return;
  if (step.sequence <= before.last->sequence) {
    throw InvalidInput("step-late", fmt::format("step {} arrived after step {}: numbers must increase; drop late steps",
                                                step.sequence, before.last->sequence));
  }
  if (step.time_us <= before.last->time_us) {
    throw InvalidInput(
        "time-backwards",
        fmt::format(
            "the capture time {} us is not after that of the last step, {} us: set the clock, or begin a new track",
            step.time_us, before.last->time_us));
  }
}

/// With times in another unit a claim would outlast all its limits.
void require_possible_speed(const TrackerState& before, const StepInput& step) {
  constexpr double kFastestMS = 1000.0;
  constexpr double kRoundingM = 1.0;  // of positions taken at nearly the same time
  if (!before.last || !step.odometry) return;
  const double moved_m = distance_m(*step.odometry);
  const double seconds = 1e-6 * static_cast<double>(step.time_us - before.last->time_us);
  if (!(moved_m > kRoundingM + kFastestMS * seconds)) return;
  throw InvalidInput("impossible-speed",
                     fmt::format("the step moves by {:.1f} m in {:g} s: time_us counts microseconds, movements metres",
                                 moved_m, seconds));
}

}  // namespace

std::optional<double> TrackerState::since_accepted_s(std::int64_t now_us) const {
  if (!accepted_time_us) return std::nullopt;
  return 1e-6 * static_cast<double>(now_us - *accepted_time_us);
}

Tracker::Tracker(MapView map, TrackSettings settings)
    : map_(std::move(map)),
      settings_(std::move(settings)),
      start_(region_of(map_, settings_.prior)),
      region_(region_of_flight(map_, settings_)) {
  assert(std::numbers::sqrt2 * settings_.beyond_map_m < TrackSearch::kAroundM);
  assert(!settings_.start_is_known || (settings_.prior.circle && settings_.prior.circle->radius_m <= Reach::kMaxM));
  // In a larger prior, particles would not find the vehicle by themselves, and each step would read the whole map.
  if (settings_.start == TrackStart::kSearch) require_searchable(start_.area_km2(), settings_.max_search_km2);
}

void Tracker::require_possible(const TrackerState& before, const StepInput& step) {
  assert(step.sequence >= 0 && step.time_us >= 0);
  assert(!step.odometry || !(std::abs(step.odometry->turn.radians()) > std::numbers::pi));
  require_in_order(before, step);
  require_possible_speed(before, step);
  // It throws where they are none.
  if (step.odometry) OdometryMotion(*step.odometry, step.covariance.value_or(OdometryCovariance{}));
}

StepResult Tracker::advance(const TrackerState& before, const StepInput& step, const StepLimits& limits) const {
  require_possible(before, step);
  return Step(*this, before, step, limits).run();
}

double Tracker::agl_m(const TrackerState& state, double above_sea_m) const {
  const auto agl_m = mean_agl_m(map_, state.filter.particles, above_sea_m);
  return agl_m ? *agl_m : required_agl_m(map_, start_.box, above_sea_m);
}

std::vector<GeoPose> Tracker::particles(const TrackerState& state, std::size_t count) const {
  const Particles& p = state.filter.particles;
  std::vector<GeoPose> poses;
  const std::size_t stride = std::max<std::size_t>(1, (p.size() + count - 1) / std::max<std::size_t>(1, count));
  for (std::size_t i = 0; i < p.size(); i += stride) {
    if (p.weight[i] > 0.0) poses.push_back(on_earth(p.at(i).pose(), map_.zone));
  }
  return poses;
}

}  // namespace roadfix
