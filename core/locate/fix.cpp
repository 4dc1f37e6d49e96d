#include "core/locate/fix.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/grid/resample.hpp"
#include "core/locate/decision.hpp"
#include "core/locate/footprint_refusal.hpp"
#include "core/locate/frame_parts.hpp"
#include "core/locate/match_poses.hpp"
#include "core/locate/other_places.hpp"
#include "core/locate/prepare.hpp"
#include "core/locate/soft_map.hpp"
#include "core/units/error.hpp"

namespace roadfix {
namespace {

// A place of no more probability is not claimed, whatever the status.
constexpr double kMostProbable = 0.5;

FixMode to_geographic(const MapView& map, const FeatureMap& cells, const SearchMode& mode, double weight,
                      const Calibration& calibration) {
  Ellipse ellipse = ellipse_of(map, mode.pose.position, mode.covariance);
  for (double& sigma_m : ellipse.sigma_m) sigma_m *= calibration.position_sigma_scale;
  FixMode result;
  result.pose = on_earth(mode.pose, map.zone);
  result.scale = mode.scale;
  result.weight = weight;
  result.rho = rho_at(map, resampled(cells, cells.cell_m, mode.scale), mode.pose).value_or(0.0);
  result.ellipse = widened(ellipse, mode.scale * cells.nadir_sigma_m);
  result.heading_sigma = Angle::radians(std::hypot(calibration.heading_sigma_scale * std::sqrt(mode.covariance[2][2]),
                                                   cells.nadir_heading_sigma.radians()));
  result.observed_cells = mode.observed_cells;
  return result;
}

/// If the offsets between frames are wrong, the frames that agree with each other are located, but the position asked
/// for is that of another one. A frame that shows hardly any road contradicts nothing.
bool contradicts(const MapView& map, const FeatureMap& own_frame, const GridPose& pose, double rho_of_all) {
  constexpr double kLeastShare = 0.5;
  if (refusal_of(own_frame) || shows_less_than_a_road_across(own_frame)) return false;
  return rho_at(map, own_frame, pose).value_or(0.0) < kLeastShare * rho_of_all;
}

/// Offsets that are all wrong alike, as by a wrong speed, may leave a frame where it fits half as well as all: along a
/// road, or with little else. By itself it is found beside the place then.
bool is_found_beside(const MapView& map, const FeatureMap& own_frame, const SearchMode& place, double nadir_sigma_m,
                     const FixOptions& options) {
  constexpr double kAroundM = 60.0;  // less than a block, from which on streets repeat
  const GeoPose pose = on_earth(place.pose, map.zone);
  const Prior around{.circle = GeoCircle{pose.position, kAroundM},
                     .box = {},
                     .heading = HeadingRange{pose.heading, Angle::degrees(15.0)}};
  const Fix found = locate(map, own_frame, around,
                           {.calibration = options.calibration,
                            .search = {.threads = options.search.threads, .deadline = options.search.deadline}});
  return claims_a_place(found) &&
         !lies_within(place.pose, told_covariance(map, *options.calibration, nadir_sigma_m, place),
                      on_grid(found.modes.front().pose, map.zone));
}

/// Refuses a likely place where the frame that is asked for, or a part of it, does not fit by itself.
void confirm(Fix& fix, const MapView& map, const FeatureMap& cells, const FixOptions& options, const SearchMode& best) {
  const std::optional<FeatureMap>& own_frame = options.own_frame;
  const FeatureMap asked_for = own_frame ? in_cells_of(map, *own_frame) : cells;
  const FeatureMap frame = resampled(asked_for, asked_for.cell_m, best.scale);
  const bool left_out = std::ranges::find(options.left_out, std::size_t{0}) != options.left_out.end();
  if (left_out || (own_frame && (contradicts(map, frame, best.pose, fix.modes.front().rho) ||
                                 is_found_beside(map, frame, best, cells.nadir_sigma_m, options)))) {
    refuse_place(
        fix, "frames-contradict",
        "the frames fit at one place together, but the one whose position is asked for does not fit there by "
        "itself, fits better beside it, or contradicts the others: check where the others were taken from, and "
        "that no frame or movement comes late");
  } else if (const char* part = contradicting_part(map, frame, best.pose)) {
    refuse_place(
        fix, "halves-contradict",
        fmt::format("the roads fit best at one place, but the {} of the frame does not fit there by itself: "
                    "part of the picture may be older than the rest, or not of the ground, or it is laid out wrongly; "
                    "leave out frames that the decoder reports as damaged, paint black what covers the ground, and "
                    "check the lens and, of a camera that leans, roll and pitch",
                    part));
  }
}

SearchOptions search_options_of(const FixOptions& options, const MapView& map) {
  SearchOptions result = options.search;
  result.cache = map.searches;
  if (options.looks_beyond_prior) result.surroundings = map.extent;
  return result;
}

Fix refused(const MapView& map, FootprintRefusal refusal) {
  Fix fix;
  fix.map = map.id;
  fix.reason = refusal.reason;
  fix.explanation = std::move(refusal.explanation);
  return fix;
}

/// All but the modes, the area and the time.
Fix fix_of(const MapView& map, const SearchResult& found, const Decision& decision) {
  Fix fix;
  fix.status = decision.status;
  fix.reason = decision.reason;
  fix.explanation = decision.explanation;
  fix.probability = decision.probability;
  fix.figures = decision.figures;
  fix.searched_share = found.scanned_share;
  fix.complete = found.complete();
  fix.headings = found.headings;
  fix.scales = found.scales;
  fix.proof = found.proof;
  fix.map = map.id;
  return fix;
}

}  // namespace

PoseRegion search_region(const MapView& map, const Prior& prior, const FixOptions& options) {
  PoseRegion region = region_of(map, prior);
  if (!(options.confidence > 0.0 && options.confidence < 1.0)) {
    throw InvalidInput("parameter-out-of-range",
                       fmt::format("the confidence is {}: give a value between 0 and 1", options.confidence));
  }
  require_scale_range(options.search.scale_range);
  require_searchable(region.area_km2(), options.max_search_km2);
  return region;
}

Fix locate(const MapView& map, const FeatureMap& features, const Prior& prior, const FixOptions& options) {
  const auto started = std::chrono::steady_clock::now();
  const PoseRegion region = search_region(map, prior, options);
  const FeatureMap cells = in_cells_of(map, features);
  const FeatureMap soft = softened(cells);
  // As given, too: little is left of one that is smaller than a cell of the map.
  for (const FeatureMap* seen : {&features, &cells, &soft}) {
    if (auto refusal = refusal_of(*seen)) return refused(map, *std::move(refusal));
  }
  const Calibration& calibration = *options.calibration;
  SearchResult found =
      search(soft_reader(map, soft.cell_m), soft.cell_m, soft, region, search_options_of(options, map));
  sort_out_other_places(map, calibration, cells.nadir_sigma_m, found);
  const Decision decision =
      decide(found, region, calibration, options.confidence, shows_less_than_a_road_across(cells));
  Fix fix = fix_of(map, found, decision);
  const auto told = std::min(decision.weights.size(), static_cast<std::size_t>(std::max(1, options.search.max_modes)));
  for (std::size_t i = 0; i < told; ++i) {
    fix.modes.push_back(to_geographic(map, cells, found.modes[i], decision.weights[i], calibration));
  }
  if (claims_a_place(fix)) confirm(fix, map, cells, options, found.modes.front());
  fix.searched_km2 = region.area_km2();
  fix.search_time = std::chrono::steady_clock::now() - started;
  return fix;
}

bool claims_a_place(const Fix& fix) {
  const bool likely = fix.probability > kMostProbable && fix.complete;
  return fix.status == FixStatus::kFix || likely;
}

void refuse_place(Fix& fix, const char* reason, std::string explanation) {
  fix.status = FixStatus::kNoFix;
  fix.reason = reason;
  fix.explanation = std::move(explanation);
  fix.probability = std::min(fix.probability, kMostProbable);
  fix.modes.front().weight = fix.probability;
}

}  // namespace roadfix
