// Drawing particles anew by their weights, and how many of them are enough.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/filter/particles.hpp"

namespace roadfix {

/// 1 / sum of squared weights: how many equally weighted particles would say as much.
double effective_sample_size(std::span<const double> weights);

/// Low-variance (systematic) resampling: `count` ancestors in ascending order; particle i is drawn floor or ceil of
/// count * weight_i times. `offset` in [0, 1) is the only random number. Weights must sum to 1.
std::vector<std::size_t> systematic_ancestors(std::span<const double> weights, std::size_t count, double offset);

struct KldOptions {
  double bin_m = 20.0;
  Angle bin_heading = Angle::degrees(10.0);
  double bin_log_scale = 0.05;
  double error = 0.05;       ///< Kullback-Leibler distance to the true posterior that is tolerated ...
  double quantile = 2.3263;  ///< ... with the probability of this standard normal quantile (0.99)
};

/// Number of samples that `bins` occupied bins ask for (Fox, Int. J. Robotics Research 22, 2003, equation 11). At least
/// 1.
double kld_sample_count(std::size_t bins, const KldOptions& options);

/// Bins that hold at least one of the particles.
std::size_t occupied_bins(const Particles& particles, std::span<const std::size_t> chosen, const KldOptions& options);

}  // namespace roadfix
