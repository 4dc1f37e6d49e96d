#include "core/track/track_settings.hpp"

namespace roadfix {

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
