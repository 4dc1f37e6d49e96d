// The hypotheses in a set of particles: groups that hang together in place and heading.
#pragma once

#include <vector>

#include "core/filter/cholesky.hpp"
#include "core/filter/particles.hpp"

namespace roadfix {

struct Cluster {
  GridPose mean;        ///< the heading is the circular mean
  double weight = 0.0;  ///< share of all weight
  PoseCovariance covariance{};
  double radius95_m = 0.0;  ///< holds 95 % of the cluster's weight
  double log_scale = 0.0;   ///< mean
  double log_scale_sigma = 0.0;

  /// 1 sigma along the major axis.
  double sigma_m() const;
};

/// Heaviest first. Particles without weight are left out; none where no other is.
std::vector<Cluster> clusters_of(const Particles& particles);

/// The first of them; some particle has weight.
Cluster heaviest_of(const Particles& particles);

}  // namespace roadfix
