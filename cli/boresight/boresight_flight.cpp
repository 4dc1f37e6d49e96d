#include "cli/boresight/boresight_flight.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <variant>

#include "cli/evaluation/frame_altitude.hpp"
#include "cli/evaluation/frame_files.hpp"
#include "core/locate/levelled_fix.hpp"
#include "core/units/error.hpp"

namespace roadfix::cli {
namespace {

using evaluation::FrameTruth;

constexpr std::string_view kPriorOutsideMap = "prior-outside-map";

void require_cameras(const std::vector<FrameTruth>& frames) {
  const auto rectified =
      std::ranges::find_if(frames, [](const auto& frame) { return std::holds_alternative<StraightDown>(frame.view); });
  if (rectified == frames.end()) return;
  throw InvalidInput("boresight-no-camera",
                     fmt::format("{} has gsd_m: of a rectified frame nobody knows how the camera looked. Give the "
                                 "frames as the camera took them, with agl_m or alt_m and fov_deg or focal_px",
                                 rectified->file.string()));
}

/// From the frame before to the one after, of the same sequence and at most kLongest apart; nullopt where there are
/// none.
std::optional<GridPoint> velocity_at(std::span<const FrameTruth> frames, std::size_t i, const UtmZone& zone) {
  constexpr double kLongestS = 10.0;  // in longer ones a vehicle turns
  const auto same = [&](std::size_t other) { return frames[other].sequence == frames[i].sequence; };
  const std::size_t first = i > 0 && same(i - 1) ? i - 1 : i;
  const std::size_t last = i + 1 < frames.size() && same(i + 1) ? i + 1 : i;
  const auto& [from, to] = std::pair(frames[first].time_s, frames[last].time_s);
  if (!from || !to || !(*to > *from) || *to - *from > kLongestS) return std::nullopt;
  const GridPoint a = zone.project(frames[first].pose.position);
  const GridPoint b = zone.project(frames[last].pose.position);
  const double s = *to - *from;
  return GridPoint{(b.east_m - a.east_m) / s, (b.north_m - a.north_m) / s};
}

Prior prior_around(const GeoPose& told, const LookOptions& options) {
  return {GeoCircle{told.position, options.radius_m}, {}, HeadingRange{told.heading, options.heading_range}};
}

class Looking {
 public:
  Looking(const std::filesystem::path& folder, const MapView& map, const RoadDetector& detector,
          const LookOptions& options)
      : folder_(folder), map_(map), detector_(detector), options_(options) {}

  FlightFrame look_for(FrameTruth frame) const {
    const Prior prior = prior_around(frame.pose, options_);
    search_region(map_, prior, options_.fix);  // throws where there is none, before the frame takes its time
    const auto altitude = evaluation::altitude_of(frame, prior, map_);
    auto& camera = std::get<FrameCamera>(frame.view);
    camera.agl_m = altitude.value().agl_m;
    const FramePixels picture = evaluation::read_frame(folder_, frame, Border::kSeen);
    const GroundView view = evaluation::view_of(picture, frame, detector_);
    constexpr std::uint64_t kSeed = 1;
    const FeatureMap features =
        detect_features(detector_, view, map_.cell_m, kSeed, options_.fix.search.deadline.stop());
    const Fix fix = locate_levelled(altitude, map_, features, prior, options_.fix);
    if (fix.status != FixStatus::kFix) return {frame.file, fix.reason};
    const FixMode& best = fix.modes.front();
    camera.agl_m = best.agl_m.value_or(camera.agl_m);
    return {frame.file, "",
            BoresightSighting{camera, picture.pixels.size(), on_grid(frame.pose, map_.zone),
                              on_grid(best.pose, map_.zone), best.scale}};
  }

 private:
  const std::filesystem::path& folder_;
  const MapView& map_;
  const RoadDetector& detector_;
  const LookOptions& options_;
};

double mean_registration_sigma_m(const std::vector<FlightFrame>& frames, const MapView& map) {
  double sum = 0.0;
  double found = 0.0;
  for (const FlightFrame& frame : frames) {
    if (!frame.sighting) continue;
    sum += map.registration_sigma_m(frame.sighting->found.position);
    found += 1.0;
  }
  return found > 0.0 ? sum / found : 0.0;
}

}  // namespace

Flight look_for(const std::filesystem::path& csv, const MapView& map, const RoadDetector& detector,
                const LookOptions& options, const OnProgress& progress) {
  const std::vector<FrameTruth> frames = evaluation::read_frames_csv(csv);
  require_cameras(frames);
  const std::filesystem::path folder = csv.parent_path();
  const Looking looking(folder, map, detector, options);
  const auto tell = [&](std::size_t done) {
    if (progress) progress(static_cast<std::int64_t>(done), static_cast<std::int64_t>(frames.size()));
  };
  Flight flight;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    tell(i);
    try {
      FlightFrame frame = looking.look_for(frames[i]);
      if (frame.sighting) frame.sighting->velocity_m_s = velocity_at(frames, i, map.zone);
      flight.frames.push_back(std::move(frame));
    } catch (const Error& error) {
      if (!is_about_input(error)) throw;
      flight.frames.push_back({frames[i].file, error.code()});
      if (error.code() == kPriorOutsideMap) continue;  // flights begin and end where they like
      flight.left_out.push_back({frames[i].file, fmt::format("{} [{}]", error.what(), error.code())});
    }
  }
  tell(frames.size());
  flight.registration_sigma_m = mean_registration_sigma_m(flight.frames, map);
  return flight;
}

}  // namespace roadfix::cli
