#include "core/match/scales.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace roadfix {

Scales Scales::for_footprint(double radius_m, double cell_m, double range) {
  assert(range >= 0.0 && range < 1.0);
  if (range == 0.0) return {};
  const double whole = -std::log1p(-range);
  const int reach = std::max(1, static_cast<int>(std::ceil(whole * radius_m / cell_m)));
  return {whole / reach, reach};
}

double Scales::factor(int index) const { return index == 0 ? 1.0 : std::exp(index * step_); }

Scales Scales::finer(int times) const { return {step_ / times, reach_ * times}; }

}  // namespace roadfix
