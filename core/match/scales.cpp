#include "core/match/scales.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace roadfix {

double max_log_scale(double range) {
  assert(range >= 0.0 && range < 1.0);
  return -std::log1p(-range);
}

Scales Scales::for_footprint(double radius_m, double cell_m, double range) {
  if (range == 0.0) return {};
  const double whole = max_log_scale(range);
  const int reach = std::max(1, static_cast<int>(std::ceil(whole * radius_m / cell_m)));
  return {whole / reach, reach};
}

double Scales::factor(int index) const { return index == 0 ? 1.0 : std::exp(index * step_); }

int Scales::nearest(double log_factor) const {
  if (reach_ == 0) return 0;
  return std::clamp(static_cast<int>(std::lround(log_factor / step_)), -reach_, reach_);
}

Scales Scales::finer(int times) const { return {step_ / times, reach_ * times}; }

}  // namespace roadfix
