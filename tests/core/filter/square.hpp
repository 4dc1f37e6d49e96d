// A square kilometre for particles, and a place in it that they see.
#pragma once

#include <span>
#include <vector>

#include "core/filter/filter.hpp"

namespace roadfix::testing {

inline const PoseRegion kSquare{{{0.0, 0.0}, {1000.0, 1000.0}}, std::nullopt, Angle(), Angle::degrees(180.0)};

/// All particles drawn around one place.
inline void start_at(Filter& filter, const Proposal& place) {
  filter.start_anew_from(std::span(&place, 1), 0.0, kSquare);
}

/// Log-likelihood of seeing the place with an error of `sigma_m` per axis.
inline std::vector<double> seen_at(const Particles& p, GridPoint place, double sigma_m) {
  std::vector<double> log_likelihoods;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double off = distance_m({p.east_m[i], p.north_m[i]}, place) / sigma_m;
    log_likelihoods.push_back(-0.5 * off * off);
  }
  return log_likelihoods;
}

}  // namespace roadfix::testing
