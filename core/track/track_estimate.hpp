// Where a track takes the vehicle to be after a step, and what became of what the step showed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/geodesy/geo_pose.hpp"
#include "core/locate/ellipse.hpp"
#include "core/units/words.hpp"

namespace roadfix {

struct TrackCluster {
  GeoPose pose;
  double weight = 0.0;  ///< share of all particles' weight, 0 to 1
  Ellipse ellipse;
  Angle heading_sigma;       ///< 1 sigma
  double radius95_m = 0.0;   ///< holds the vehicle with 95 %, if it belongs to this cluster at all
  double scale = 1.0;        ///< how many times larger the ground is than the feature maps say, within the scale range
  double scale_sigma = 0.0;  ///< 1 sigma
};

/// What a step's feature map was used for; kRepeated = nothing, since the camera or its link has stopped (LastView).
enum class Measurement { kNone, kSearched, kAccepted, kRejected, kUseless, kRepeated };
inline constexpr std::array<Word<Measurement>, 6> kMeasurements{{{"none", Measurement::kNone},
                                                                 {"searched", Measurement::kSearched},
                                                                 {"accepted", Measurement::kAccepted},
                                                                 {"rejected", Measurement::kRejected},
                                                                 {"useless", Measurement::kUseless},
                                                                 {"repeated", Measurement::kRepeated}}};

/// Why a step claims no place: the first condition of a claim that does not hold (docs/tracks.md, "When a place is
/// claimed").
enum class Unclaimed {
  kFrameRepeated,  ///< or the camera stands still
  kFrameRejected,
  kSeveralPlaces,
  kPlaceTooWide,
  kTooFewAgree,
  kNoneAgreedLately,
  kFramesAgreeLess,
  kMayBeChance,
  kOthersNotRuledOut,
  kNotBorneOut,
};
inline constexpr std::array<Word<Unclaimed>, 10> kUnclaimed{{{"frame-repeated", Unclaimed::kFrameRepeated},
                                                             {"frame-rejected", Unclaimed::kFrameRejected},
                                                             {"several-places", Unclaimed::kSeveralPlaces},
                                                             {"place-too-wide", Unclaimed::kPlaceTooWide},
                                                             {"too-few-agree", Unclaimed::kTooFewAgree},
                                                             {"none-agreed-lately", Unclaimed::kNoneAgreedLately},
                                                             {"frames-agree-less", Unclaimed::kFramesAgreeLess},
                                                             {"may-be-chance", Unclaimed::kMayBeChance},
                                                             {"others-not-ruled-out", Unclaimed::kOthersNotRuledOut},
                                                             {"not-borne-out", Unclaimed::kNotBorneOut}}};
/// For a person, with what to do.
const char* explanation_of(Unclaimed why);

struct TrackEstimate {
  std::int64_t sequence = 0;
  std::int64_t time_us = 0;
  std::optional<Unclaimed> unclaimed = Unclaimed::kTooFewAgree;  ///< nullopt = converged
  std::vector<TrackCluster> clusters;                            ///< heaviest first, at most kMaxClusters of them
  std::size_t cluster_count = 0;                                 ///< of all, also those that are not among `clusters`
  std::size_t particles = 0;                                     ///< number of them
  std::uint64_t resets = 0;                                      ///< times that the belief was thrown away
  Measurement measurement = Measurement::kNone;
  /// How many times likelier the measurement was under the belief before it than by chance, on average.
  double mean_likelihood = 0.0;
  double doubt = 0.0;                      ///< how much worse late measurements fit than earlier ones, 0 to 1
  std::optional<double> since_accepted_s;  ///< nullopt = no measurement was accepted yet
  bool odometry_is_wrong = false;          ///< was found so, and a drift of it is learned
  std::optional<double> agl_m;    ///< where it follows from the altitude: the height above ground of what was seen
  std::int64_t missed_steps = 0;  ///< sequence numbers left out before this step
  static constexpr std::size_t kMaxClusters = 8;

  /// Only then the first cluster is a position to fly on.
  bool converged() const { return !unclaimed; }
};

}  // namespace roadfix
