// One feature map against a map: where is the UAV? An honest answer is `fix`, `ambiguous` or `no_fix` with the reason.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/geodesy/geo_pose.hpp"
#include "core/grid/combine.hpp"
#include "core/grid/feature_map.hpp"
#include "core/locate/calibration.hpp"
#include "core/locate/ellipse.hpp"
#include "core/locate/map_view.hpp"
#include "core/locate/prior.hpp"
#include "core/search/search.hpp"

namespace roadfix {

struct FixOptions {
  double confidence = 0.99;                ///< status is `fix` only if the probability of the best mode reaches it
  std::optional<double> max_search_km2{};  ///< beyond it LimitExceeded
  /// The best place is compared with what lies just beyond the prior (SearchOptions::surroundings).
  bool looks_beyond_prior = true;
  /// If several frames were laid together: the one whose position is asked for. It has to confirm a likely place by
  /// itself.
  std::optional<FeatureMap> own_frame{};
  /// Those that were laid around it, from where each was taken: locate_levelled() lays them together anew.
  std::vector<PlacedFeatures> others{};
  /// FramesTogether::left_out: the own frame, 0, confirms no place if it is one of them.
  std::vector<std::size_t> left_out{};
  std::shared_ptr<const Calibration> calibration = shipped_calibration();  ///< never nullptr
  SearchOptions search{};  ///< all but the cache and the surroundings, which the map gives
};

enum class FixStatus { kFix, kAmbiguous, kNoFix };

struct FixMode {
  GeoPose pose;
  double scale = 1.0;   ///< of the feature map's size
  double weight = 0.0;  ///< share of the posterior of this mode, all modes sum to at most 1
  double rho = 0.0;     ///< equation (5), of the cells as they are
  Ellipse ellipse;
  Angle heading_sigma;
  std::int64_t observed_cells = 0;
  std::optional<double> agl_m{};  ///< where it follows from the altitude: height above the ground of this place
};

struct Fix {
  FixStatus status = FixStatus::kNoFix;
  std::string reason;  ///< stable word for no_fix and ambiguous ("too-few-roads", "not-above-chance", ...), else empty
  std::string explanation;               ///< the same for a person, with what to do
  double probability = 0.0;              ///< that the true position lies within kRegionSigmas of the best mode
  std::vector<FixMode> modes;            ///< best first; also given for no_fix, as a hint that must not be flown on
  std::optional<SearchFigures> figures;  ///< of the best mode
  double searched_km2 = 0.0;
  /// Share of the poses of the region that were scored in time; of the others nothing is known.
  double searched_share = 1.0;
  bool complete = true;  ///< false where the time limit ended the search
  int headings = 0;
  int scales = 1;
  std::optional<SearchProof> proof;  ///< where one was asked for
  MapId map;
  std::chrono::duration<double, std::milli> search_time{};
};

/// The region that locate() searches. Throws what that throws about map, prior and options: call it before detecting
/// the roads of a frame, which takes long.
PoseRegion search_region(const MapView& map, const Prior& prior, const FixOptions& options);

/// Search (core/search/search.hpp), then decide (calibration.hpp says where probabilities come from).
/// Throws InvalidInput for a prior that does not meet the map and for a feature map that cannot be used at all,
/// LimitExceeded and Interrupted by the options.
Fix locate(const MapView& map, const FeatureMap& features, const Prior& prior, const FixOptions& options);

/// Whether somebody may take the best place for where the UAV is, whatever the status.
bool claims_a_place(const Fix& fix);
/// Makes it no_fix for that reason, its best place no likely one. There is a mode.
void refuse_place(Fix& fix, const char* reason, std::string explanation);

}  // namespace roadfix
