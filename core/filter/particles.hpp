// Weighted samples of where the UAV may be, as a structure of arrays.
#pragma once

#include <cstddef>
#include <vector>

#include "core/units/planar.hpp"

namespace roadfix {

/// Metres on the grid, radians clockwise from grid north. The drift is the velocity over ground that the motion input
/// does not tell: wind for planar motion and odometry, the whole velocity where nothing is told.
struct ParticleState {
  double east_m = 0.0;
  double north_m = 0.0;
  double heading_rad = 0.0;
  double drift_east_m_s = 0.0;
  double drift_north_m_s = 0.0;
  /// Natural logarithm of how many times larger the ground below is than was told, since the altitude is only roughly
  /// known.
  double log_scale = 0.0;

  GridPose pose() const { return {{east_m, north_m}, Angle::radians(heading_rad)}; }
  friend bool operator==(const ParticleState&, const ParticleState&) = default;
};

/// Invariant: all columns are equally long.
struct Particles {
  std::vector<double> east_m;
  std::vector<double> north_m;
  std::vector<double> heading_rad;  ///< in (-pi, pi]
  std::vector<double> drift_east_m_s;
  std::vector<double> drift_north_m_s;
  std::vector<double> log_scale;
  std::vector<double> weight;  ///< sum to 1; of those that left the region 0, until they are drawn anew

  std::size_t size() const { return weight.size(); }
  void resize(std::size_t count) {
    for (auto* column : {&east_m, &north_m, &heading_rad, &drift_east_m_s, &drift_north_m_s, &log_scale, &weight}) {
      column->resize(count);
    }
  }
  ParticleState at(std::size_t i) const {
    return {east_m[i], north_m[i], heading_rad[i], drift_east_m_s[i], drift_north_m_s[i], log_scale[i]};
  }
  void set(std::size_t i, const ParticleState& state) {
    east_m[i] = state.east_m;
    north_m[i] = state.north_m;
    heading_rad[i] = state.heading_rad;
    drift_east_m_s[i] = state.drift_east_m_s;
    drift_north_m_s[i] = state.drift_north_m_s;
    log_scale[i] = state.log_scale;
  }
  friend bool operator==(const Particles&, const Particles&) = default;
};

}  // namespace roadfix
