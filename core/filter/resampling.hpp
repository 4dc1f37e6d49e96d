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

/// Number of samples that `bins` occupied bins ask for, so that the Kullback-Leibler distance to the true posterior is
/// at most 0.05 with a probability of 0.99 (Fox, Int. J. Robotics Research 22, 2003, equation 11). At least 1.
double kld_sample_count(std::size_t bins);

/// Bins of 20 m, 10 degrees and 5 % of the scale that hold at least one of the particles.
std::size_t occupied_bins(const Particles& particles, std::span<const std::size_t> chosen);

}  // namespace roadfix
