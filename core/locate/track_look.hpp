// A track that is sure of its place looks around it from time to time, by a search that does not take the odometry's
// word. Where the odometry is worse than it says, the particles lag behind the vehicle: along a road, or by a block,
// frames still agree better there than by chance, so that nothing but a comparison with the places beside tells. Only a
// place that such looks bear out is claimed.
#pragma once

#include <cstdint>
#include <vector>

#include "core/filter/clusters.hpp"
#include "core/filter/filter.hpp"
#include "core/locate/track_search.hpp"

namespace roadfix {

/// How long ago, and how far back, a look bore the place out.
struct LookAge {
  std::int64_t us = 0;
  double flown_m = 0.0;

  /// Time for another look.
  bool is_due() const;
  /// Too old to claim a place on, should another look leave it open.
  bool is_outdated() const;
};

/// What a search around a belief says of it.
struct Look {
  enum class Outcome { kBorneOut, kTurned, kBeside, kOpen };  ///< turned: there, with another heading
  Outcome outcome = Outcome::kOpen;
  std::vector<Proposal> places;  ///< that are likely instead; only of kTurned and kBeside
};

/// Whether the frame fits better where the vehicle is believed to be if that is turned: a sign, for a look to follow,
/// that one turn was told wrong.
bool fits_better_turned(const MapView& map, const FeatureMap& frame, const Cluster& belief);

/// Searches as far around `belief` as the odometry may have misled it since the last look, `flown_m` ago. Open where
/// that lies beyond the map or is too much to search.
Look look_around(const TrackSearch& search, const MapView& map, const FeatureMap& frame, const Cluster& belief,
                 double flown_m);

}  // namespace roadfix
