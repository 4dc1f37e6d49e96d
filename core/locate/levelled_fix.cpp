#include "core/locate/levelled_fix.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/grid/relief.hpp"
#include "core/grid/resample.hpp"
#include "core/locate/told_frames.hpp"

namespace roadfix {
namespace {

// What is displaced by less is found as it is, and as sure.
constexpr double kLeastShiftM = 3.0;

/// Whether a search that was told what lies around a place found that place: displaced, it may have been beside it.
bool is_found_again(const GridPose& found, const GridPose& told) {
  constexpr double kBesideM = 50.0;
  const Angle turned = Angle::degrees(8.0);
  return distance_m(found.position, told.position) <= kBesideM &&
         angular_distance(found.heading, told.heading) <= turned;
}

double agl_at(const MapView& map, const Altitude& altitude, GridPoint point) {
  if (!altitude.above_sea_m) return altitude.agl_m;
  return map.terrain->height_above_ground_m(point, *altitude.above_sea_m).value_or(altitude.agl_m);
}

/// Of what was seen from so much higher.
Altitude raised(const Altitude& altitude, double higher_m) {
  Altitude higher = altitude;
  higher.agl_m += higher_m;
  if (higher.above_sea_m) *higher.above_sea_m += higher_m;
  return higher;
}

/// All that were laid together for a fix, the one whose position is asked for first.
std::vector<PlacedFeatures> frames_of(const FeatureMap& features, const FixOptions& options) {
  if (!options.own_frame) return {{features, {}}};
  std::vector<PlacedFeatures> frames{{*options.own_frame, {}}};
  frames.insert(frames.end(), options.others.begin(), options.others.end());
  return frames;
}

/// A frame where it was taken, if the first of all was at `place`.
struct TakenFrame {
  double scale;     ///< of what it shows, to that of the features
  FeatureMap seen;  ///< in the size that this height gives it
  Relief relief;
};

TakenFrame taken_from(const MapView& map, const PlacedFeatures& frame, const Altitude& altitude,
                      const GridPose& place) {
  const GridPose pose = moved(place, frame.offset);
  const Altitude own = raised(altitude, frame.higher_m);
  const double agl_m = agl_at(map, own, pose.position);
  return {agl_m / own.agl_m, seen_from(frame.features, own, agl_m), Relief(*map.terrain, pose, agl_m)};
}

/// By the relief, and by heights of the ground that differ from that of the first frame, of whose scale all were.
bool is_displaced(const MapView& map, std::span<const PlacedFeatures> frames, const Altitude& altitude,
                  const GridPose& place) {
  const double scale = agl_at(map, altitude, place.position) / altitude.agl_m;
  return std::ranges::any_of(frames, [&](const PlacedFeatures& frame) {
    const TakenFrame taken = taken_from(map, frame, altitude, place);
    const double grown_m = 0.5 * taken.seen.side_m() * std::abs(1.0 - scale / taken.scale);
    return grown_m + taken.relief.largest_shift_m(taken.seen) >= kLeastShiftM;
  });
}

/// locate_from(), of frames in place of those that the options have.
Fix locate_frames(const Altitude& altitude, const MapView& map, std::vector<PlacedFeatures> frames, const Prior& prior,
                  FixOptions options) {
  if (!options.own_frame) return locate_from(altitude, map, frames.front().features, prior, options);
  FramesTogether laid = laid_together(frames, std::numeric_limits<double>::infinity());
  options.own_frame = std::move(frames.front().features);
  options.left_out = std::move(laid.left_out);
  return locate_from(altitude, map, laid.features, prior, options);
}

}  // namespace

std::vector<PlacedFeatures> levelled_frames(const MapView& map, std::span<const PlacedFeatures> frames,
                                            const Altitude& altitude, const GridPose& place) {
  std::vector<PlacedFeatures> level;
  for (const PlacedFeatures& frame : frames) {
    const TakenFrame taken = taken_from(map, frame, altitude, place);
    const double cell_m = level.empty() ? taken.seen.cell_m : level.front().features.cell_m;
    level.push_back({resampled(levelled(taken.seen, taken.relief), cell_m), frame.offset});
  }
  return level;
}

Fix locate_levelled(const std::optional<Altitude>& altitude, const MapView& map, const FeatureMap& features,
                    const Prior& prior, const FixOptions& options) {
  Fix fix = locate_from(altitude, map, features, prior, options);
  if (!altitude || !map.terrain || fix.modes.empty()) return fix;
  const GridPose place = on_grid(fix.modes.front().pose, map.zone);
  const std::vector<PlacedFeatures> frames = frames_of(features, options);
  if (!is_displaced(map, frames, *altitude, place)) return fix;
  const Altitude there{altitude->above_sea_m, agl_at(map, *altitude, place.position)};
  Fix again = locate_frames(there, map, levelled_frames(map, frames, *altitude, place), prior, options);
  again.search_time += fix.search_time;
  fix.search_time = again.search_time;
  if (again.complete && !again.modes.empty() && is_found_again(on_grid(again.modes.front().pose, map.zone), place)) {
    return again;
  }
  if (!claims_a_place(fix)) return fix;
  if (!again.complete) return again;
  refuse_place(fix, "terrain-contradicts",
               "the roads fit best at a place where the relief of the ground should displace them otherwise: check the "
               "heights of the map's ground, and the height above it or the sea");
  return fix;
}

}  // namespace roadfix
