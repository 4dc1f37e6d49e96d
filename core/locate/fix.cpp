#include "core/locate/fix.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/grid/cell_moments.hpp"
#include "core/grid/resample.hpp"
#include "core/locate/compared_cells.hpp"
#include "core/locate/decision.hpp"
#include "core/locate/ellipse.hpp"
#include "core/locate/match_poses.hpp"
#include "core/locate/prepare.hpp"
#include "core/locate/search_figures.hpp"
#include "core/match/score.hpp"
#include "core/units/error.hpp"

namespace roadfix {
namespace {

// On less, one place always fits far better than the others, and what tells chance from more than chance no longer
// holds.
constexpr double kMinGroundM2 = 16.0 * kSampleM2;

constexpr double kOnePlaceM = 25.0;  // places farther apart are two, however badly either is known

struct Refusal {
  const char* reason;
  std::string explanation;
};

/// nullopt where there is something to search for, as far as the feature map alone tells.
std::optional<Refusal> refusal_of(const FeatureMap& features) {
  const double ground_m2 = features.cell_m * features.cell_m * static_cast<double>(features.cells.observed_count());
  if (ground_m2 == 0.0) {
    return Refusal{
        "footprint-unobserved",
        "no cell of the feature map was observed, or only a corner far from the UAV: the frame shows no ground to "
        "match"};
  }
  if (ground_m2 < kMinGroundM2) {
    return Refusal{
        "footprint-too-small",
        fmt::format("the frame shows {:.0f} m2 of ground, and at least {:.0f} m2 are needed to tell places apart: "
                    "check its scale (metres per pixel or cell), fly higher, or combine several frames",
                    ground_m2, kMinGroundM2)};
  }
  if (moments_of(features.cells).variance() < kMinVariance) {
    return Refusal{"too-few-roads",
                   "the feature map shows hardly any road, or road everywhere: there is nothing to match"};
  }
  return std::nullopt;
}

bool shows_less_than_a_road_across(const FeatureMap& features) {
  const double cell_m2 = features.cell_m * features.cell_m;
  const auto roads = std::ranges::count_if(features.cells.cells(), is_road);
  const double across_m = std::sqrt(cell_m2 * static_cast<double>(features.cells.observed_count()));
  return cell_m2 * static_cast<double>(roads) < kRoadWidthM * across_m;
}

FixMode to_geographic(const MapView& map, const FeatureMap& cells, const SearchMode& mode, double weight,
                      const Calibration& calibration) {
  const Ellipse ellipse = ellipse_of(map, mode.pose.position, mode.covariance);
  FixMode result;
  result.pose = on_earth(mode.pose, map.zone);
  result.scale = mode.scale;
  result.weight = weight;
  result.rho = rho_at(map, resampled(cells, cells.cell_m, mode.scale), mode.pose).value_or(0.0);
  for (std::size_t axis : {0U, 1U}) {
    result.sigma_m[axis] = std::hypot(calibration.position_sigma_scale * ellipse.sigma_m[axis], cells.nadir_sigma_m);
  }
  result.ellipse_heading = ellipse.heading;
  result.heading_sigma = Angle::radians(calibration.heading_sigma_scale * std::sqrt(mode.covariance[2][2]));
  result.observed_cells = mode.observed_cells;
  return result;
}

/// Of frames that were not where they are said to have been, those that agree with each other find their place, and the
/// pose that is asked for is that of another one. A frame that shows hardly any road cannot tell.
bool contradicts(const MapView& map, const FeatureMap& own_frame, const SearchMode& best, double rho_of_all) {
  constexpr double kLeastShare = 0.5;
  const FeatureMap cells = in_cells_of(map, own_frame);
  if (refusal_of(cells) || shows_less_than_a_road_across(cells)) return false;
  const auto rho = rho_at(map, resampled(cells, cells.cell_m, best.scale), best.pose);
  return rho.value_or(0.0) < kLeastShare * rho_of_all;
}

// What is no likelier is no claim of a place, whatever the status.
constexpr double kMostProbable = 0.5;

bool claims_a_place(const Fix& fix) {
  const bool likely = fix.probability > kMostProbable && fix.reason != kTimeLimitReason;
  return fix.status == FixStatus::kFix || likely;
}

void refuse_contradicting_frames(Fix& fix) {
  fix.status = FixStatus::kNoFix;
  fix.reason = "frames-contradict";
  fix.explanation =
      "the frames fit at one place together, but the one whose position is asked for does not fit there by itself: "
      "check where the others were taken from, and that no frame or movement comes late";
  fix.probability = std::min(fix.probability, kMostProbable);
  fix.modes.front().weight = fix.probability;
}

void require_valid(const FixOptions& options, double area_km2) {
  if (!(options.confidence > 0.0 && options.confidence < 1.0)) {
    throw InvalidInput("confidence-out-of-range",
                       fmt::format("the confidence is {}: give a value between 0 and 1", options.confidence));
  }
  require_scale_range(options.scale_range);
  require_searchable(area_km2, options.max_search_km2);
}

SearchOptions search_options_of(const FixOptions& options, const MapView& map,
                                std::chrono::steady_clock::time_point started) {
  SearchOptions result;
  result.max_modes = options.max_modes;
  result.scale_range = options.scale_range;
  result.cache = map.searches;
  if (options.looks_beyond_prior) result.surroundings = map.extent;
  result.threads = options.threads;
  result.progress = options.progress;
  result.stop = options.stop;
  result.proof_time = options.proof_time;
  if (options.time_limit) result.deadline = started + *options.time_limit;
  return result;
}

/// Whether a position lies beyond the region of the mode that a probability speaks of.
bool is_beyond(const MapView& map, const Calibration& calibration, double nadir_sigma_m, const SearchMode& mode,
               GridPoint position) {
  const double scale2 = calibration.position_sigma_scale * calibration.position_sigma_scale;
  const PositionCovariance told = position_covariance(map, mode.pose.position, mode.covariance);
  const double nadir2 = nadir_sigma_m * nadir_sigma_m;
  const double east2 = scale2 * told.east_east + nadir2;
  const double north2 = scale2 * told.north_north + nadir2;
  const double both = scale2 * told.east_north;
  const double east = position.east_m - mode.pose.position.east_m;
  const double north = position.north_m - mode.pose.position.north_m;
  const double squared =
      (north2 * east * east - 2.0 * both * east * north + east2 * north * north) / (east2 * north2 - both * both);
  return squared > kRegionSigmas * kRegionSigmas;
}

/// Another peak that the region of the best mode leaves out is a place of its own, however near it is; so is one that
/// no operator would take for the same, however wide the region.
void count_nearby(const MapView& map, const Calibration& calibration, double nadir_sigma_m, SearchResult& found) {
  if (!found.nearby) return;
  const SearchMode& nearby = *found.nearby;
  const SearchMode& best = found.modes.front();
  if (distance_m(best.pose.position, nearby.pose.position) <= kOnePlaceM &&
      !is_beyond(map, calibration, nadir_sigma_m, best, nearby.pose.position)) {
    return;
  }
  const auto lower = [&](const SearchMode& mode) { return mode.score < nearby.score; };
  found.modes.insert(std::find_if(found.modes.begin() + 1, found.modes.end(), lower), nearby);
  std::vector<double>& rivals = found.background.rivals_within;
  rivals.insert(std::ranges::upper_bound(rivals, nearby.score, std::ranges::greater{}), nearby.score);
}

}  // namespace

Fix locate(const MapView& map, const FeatureMap& features, const Prior& prior, const FixOptions& options) {
  const auto started = std::chrono::steady_clock::now();
  const PoseRegion region = region_of(map, prior);
  require_valid(options, region.area_km2());
  const FeatureMap cells = in_cells_of(map, features);
  Fix fix;
  fix.map_name = map.name;
  fix.map_version = map.version;
  const FeatureMap compared = compared_cells(cells);
  // As it was given, too: of one smaller than a cell of the map next to nothing is left.
  for (const FeatureMap* seen : {&features, &cells, &compared}) {
    if (auto refusal = refusal_of(*seen)) {
      fix.reason = refusal->reason;
      fix.explanation = std::move(refusal->explanation);
      return fix;
    }
  }
  const Calibration& calibration = options.calibration ? *options.calibration : default_calibration();
  SearchResult found = search(compared_cells(map, compared.cell_m), compared.cell_m, compared, region,
                              search_options_of(options, map, started));
  count_nearby(map, calibration, cells.nadir_sigma_m, found);
  Decision decision = decide(found, calibration, options.confidence);
  fix.status = decision.status;
  fix.reason = std::move(decision.reason);
  fix.explanation = std::move(decision.explanation);
  if (fix.reason == kNotAboveChanceReason && shows_less_than_a_road_across(cells)) {
    fix.reason = "too-few-roads";
    fix.explanation =
        "the frame shows less road than a single one across the footprint: use a larger footprint, or fly on to where "
        "roads are";
  }
  fix.probability = decision.probability;
  const auto told = std::min(decision.weights.size(), static_cast<std::size_t>(std::max(1, options.max_modes)));
  for (std::size_t i = 0; i < told; ++i) {
    fix.modes.push_back(to_geographic(map, cells, found.modes[i], decision.weights[i], calibration));
  }
  if (claims_a_place(fix) && options.own_frame &&
      contradicts(map, *options.own_frame, found.modes.front(), fix.modes.front().rho)) {
    refuse_contradicting_frames(fix);
  }
  fix.figures = decision.figures;
  fix.searched_km2 = region.area_km2();
  fix.searched_share = found.scanned_share;
  fix.complete = fix.reason != kTimeLimitReason;
  fix.headings = found.headings;
  fix.scales = found.scales;
  fix.proof = found.proof;
  fix.search_time = std::chrono::steady_clock::now() - started;
  return fix;
}

}  // namespace roadfix
