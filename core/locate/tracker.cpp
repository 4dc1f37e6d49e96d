#include "core/locate/tracker.hpp"

#include <algorithm>
#include <utility>

#include "core/locate/prepare.hpp"
#include "core/locate/track_geometry.hpp"
#include "core/locate/tracker_step.hpp"
#include "core/match/scales.hpp"

namespace roadfix {
namespace {

AcceptanceRegion region_of_flight(const MapView& map, const TrackSettings& settings) {
  require_scale_range(settings.vehicle.scale_range);
  return {region_of(map, {}), settings.beyond_map_m, max_log_scale(settings.vehicle.scale_range)};
}

}  // namespace

const char* to_string(Measurement measurement) {
  switch (measurement) {
    case Measurement::kNone:
      return "none";
    case Measurement::kSkipped:
      return "skipped";
    case Measurement::kSearched:
      return "searched";
    case Measurement::kAccepted:
      return "accepted";
    case Measurement::kRejected:
      return "rejected";
    case Measurement::kUseless:
      return "useless";
    case Measurement::kRepeated:
      break;
  }
  return "repeated";
}

Wind Wind::of(std::optional<double> sigma_m_s, std::optional<double> walk) {
  constexpr double kRootSeconds = 50.0;
  return {sigma_m_s.value_or(kRootSeconds * walk.value_or(0.0)), walk.value_or(sigma_m_s.value_or(0.0) / kRootSeconds)};
}

TrackSettings TrackSettings::paper(int particles) {
  TrackSettings settings;
  settings.start = TrackStart::kUniform;
  settings.recovers = false;
  settings.beyond_map_m = 0.0;
  settings.filter = FilterOptions::paper(particles);
  settings.measurement_model.kind = LikelihoodKind::kEquation7;
  return settings;
}

Tracker::Tracker(MapView map, TrackSettings settings)
    : map_(std::move(map)),
      settings_(std::move(settings)),
      start_(region_of(map_, settings_.prior)),
      region_(region_of_flight(map_, settings_)) {
  // Particles alone would not find the vehicle there either, and each step would read the whole map for them.
  if (settings_.start == TrackStart::kSearch) require_searchable(start_.area_km2(), settings_.max_search_km2);
}

StepResult Tracker::advance(const TrackerState& before, const StepInput& step, const StepLimits& limits) const {
  return Step(*this, before, step, limits).run();
}

std::vector<GeoPose> Tracker::particles(const TrackerState& state, std::size_t count) const {
  const Particles& p = state.filter.particles;
  std::vector<GeoPose> poses;
  const std::size_t stride = std::max<std::size_t>(1, (p.size() + count - 1) / std::max<std::size_t>(1, count));
  for (std::size_t i = 0; i < p.size(); i += stride) {
    poses.push_back(on_earth(p.at(i).pose(), map_.zone));
  }
  return poses;
}

}  // namespace roadfix
