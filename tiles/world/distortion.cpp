#include "tiles/world/distortion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace roadfix::world {

Distortion::Distortion(Random& random, std::span<const double> lengths_m, double strength) {
  constexpr double kTau = 2.0 * std::numbers::pi;
  for (const double about : lengths_m) {
    const double length = about * random.uniform(0.85, 1.15);
    const double heading = random.uniform(0.0, kTau);
    const double push = random.uniform(0.0, kTau);
    const double amplitude = length * strength;
    waves_.push_back({PlanPoint(std::cos(heading), std::sin(heading)) * (kTau / length),
                      PlanPoint(std::cos(push), std::sin(push)) * amplitude, random.uniform(0.0, kTau)});
  }
}

PlanPoint Distortion::operator()(PlanPoint p) const {
  PlanPoint moved = p;
  for (const Wave& wave : waves_) moved += wave.amplitude * std::sin(wave.frequency.dot(p) + wave.phase);
  return moved;
}

Polyline Distortion::bent(PlanPoint from, PlanPoint to, double step_m) const {
  const int pieces = std::max(1, static_cast<int>(std::ceil(cv::norm(to - from) / step_m)));
  Polyline line;
  for (int i = 0; i <= pieces; ++i) line.push_back((*this)(from + (to - from) * (static_cast<double>(i) / pieces)));
  return line;
}

}  // namespace roadfix::world
