#include "core/locate/track_settings.hpp"

namespace roadfix {

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

}  // namespace roadfix
