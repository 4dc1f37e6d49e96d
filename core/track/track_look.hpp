// A track that is sure of its place looks around it from time to time, by a search that does not trust the odometry. If
// the odometry is worse than it says, the particles lag behind the vehicle: along a road, or by a block. Frames still
// agree better there than by chance, so that only a comparison with neighbouring places shows it. Only a place that
// looks bear out is claimed.
#pragma once

#include <cstdint>
#include <vector>

#include "core/filter/clusters.hpp"
#include "core/filter/filter.hpp"
#include "core/track/reach.hpp"
#include "core/track/track_search.hpp"

namespace roadfix {

/// Time and distance flown since a look bore the place out.
struct LookAge {
  std::int64_t us = 0;
  double flown_m = 0.0;

  /// Time for another look.
  bool is_due() const;
  /// Too old to claim a place on, should another look leave it open.
  bool is_outdated() const;
};

/// What a search around a belief found.
struct Look {
  enum class Outcome {
    kBorneOut,   ///< the vehicle, where it was believed to be
    kTurned,     ///< the vehicle there, with another heading
    kElsewhere,  ///< the vehicle at another place nearby
    kOpen,       ///< none of these for certain
  };
  Outcome outcome = Outcome::kOpen;
  std::vector<Proposal> places;  ///< likely poses, for kTurned and kElsewhere
};

/// Whether the frame fits better at the believed position with another heading: a sign, to be followed by a look, that
/// the odometry told a turn wrong.
bool fits_better_turned(const MapView& map, const FeatureMap& frame, const Cluster& belief);

/// Where a look searches.
struct LookArea {
  GridPose centre;
  double radius_m = 0.0;
  Angle heading_half_width;

  /// As far around a belief as the odometry may have misled it since the last look, so much flown ago.
  static LookArea around(const GridPose& belief, double flown_m);
  /// All of it, and as far and as wide as `around`, which does not cover it.
  static LookArea of(const Reach& reach, const LookArea& around);
  bool covers(const Reach& reach) const;
  /// nullopt where it lies off the map.
  std::optional<Prior> prior(const MapView& map) const;
};

/// kOpen if the area lies off the map or is too large to search.
Look look_around(const TrackSearch& search, const MapView& map, const FeatureMap& frame, const Cluster& belief,
                 const LookArea& area);

}  // namespace roadfix
