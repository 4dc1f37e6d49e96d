#include "cli/fly/fly_ground.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include "cli/fly/area.hpp"
#include "cli/fly/fly_course.hpp"
#include "cli/map_notes.hpp"
#include "cli/terminal.hpp"
#include "core/units/error.hpp"
#include "core/units/index_range.hpp"
#include "core/units/text.hpp"
#include "tiles/imagery/read_orthoimage.hpp"
#include "tiles/view/map_file_view.hpp"

namespace roadfix::cli {
namespace {

void require_sendable_frames(const FlyOptions& options, bool over_imagery) {
  if (options.service.base.empty()) {
    throw InvalidInput("option-without-effect",
                       "--send frames leaves it to a service to detect roads: name it with --server");
  }
  if (!over_imagery) {
    throw InvalidInput("option-without-effect",
                       "a map shows roads and no pictures: name imagery with --over, or leave out --send frames");
  }
  if (options.detector != DetectorChoice{}) {
    throw InvalidInput("option-without-effect",
                       "with --send frames the service detects roads by its own detector: give --detector, --model, "
                       "--orientations and --tree-... to roadfix serve");
  }
}

void look_at_map(const FlyOptions& options, const MapView& map, Ground& ground) {
  const bool itself = options.over.empty();
  const MapView from = itself ? map : view_of_file(options.over);
  if (!(from.zone == map.zone)) {
    throw InvalidInput("map-of-another-zone", fmt::format("{} lies in another UTM zone than {}: take maps of one place",
                                                          options.over, options.map));
  }
  ground.sensor = fly::make_simulated_sensor(from, ground.footprint, options.quality);
  ground.box = from.extent;
  ground.what = fmt::format("feature maps cut out of {}", itself ? options.map : options.over);
}

void look_at_imagery(const FlyOptions& options, const MapView& map, Ground& ground) {
  ground.imagery = std::make_unique<const Orthoimage>(read_orthoimage(options.over, map.zone));
  ground.box = ground.imagery->box();
  ground.sensor = ground.detector ? fly::make_imaging_sensor(*ground.imagery, *ground.detector, ground.footprint,
                                                             options.camera, map.cell_m)
                                  : fly::make_camera(*ground.imagery, ground.footprint, options.camera, map.cell_m);
}

/// A service knows from where pictures are taken, and not feature maps.
void require_measurable(const FlyOptions& options, const std::vector<fly::Recording>& recordings) {
  if (options.service.base.empty() || options.send == "frames") return;
  for (const fly::Recording& recording : recordings) {
    for (const fly::RecordedFrame& frame : recording.frames) {
      if (!frame.altitude || !frame.altitude->above_sea_m) continue;
      throw InvalidInput(
          "option-without-effect",
          fmt::format("{} tells heights above the sea, by which a service measures pictures, not feature "
                      "maps: add --send frames",
                      options.over));
    }
  }
}

void look_at_recordings(const FlyOptions& options, const MapView& map, Ground& ground) {
  if (options.course != "random" || !options.kidnap.empty()) {
    throw InvalidInput("option-without-effect", "a recorded flight has its course: leave out --course and --kidnap");
  }
  fly::RecordingOptions recorded;
  recorded.border = options.border;
  recorded.detector = ground.detector.get();
  recorded.cell_m = map.cell_m;
  recorded.step_s = options.plan.handling.step_s;
  recorded.max_frames = static_cast<std::size_t>(options.steps.value_or(0));
  recorded.agl_m = [&map](GridPoint below, double above_sea_m) {
    return required_agl_m(map, {below, below}, above_sea_m);
  };
  Progress progress("reading", "frames");
  ground.recordings = fly::read_recordings(options.over, map.zone, recorded, progress.updates());
  require_measurable(options, ground.recordings);
  ground.footprint = ground.recordings.front().frames.front().footprint;
}

void note_frames_beyond(const MapView& map, const Ground& ground, const FlyOptions& options) {
  std::int64_t all = 0;
  std::int64_t beyond = 0;
  for (const fly::Recording& recording : ground.recordings) {
    all += std::ssize(recording.frames);
    beyond += std::ranges::count_if(
        recording.frames, [&](const fly::RecordedFrame& frame) { return !map.extent.contains(frame.truth.position); });
  }
  if (beyond == 0) return;
  fmt::print(stderr, "note: {} of the {} frames of {} were taken beyond the map: no place can be right there\n", beyond,
             all, options.over);
}

/// Where the whole footprint lies on the map and on what is flown over, whatever the heading.
GridBox flying_box(const Footprint& footprint, const GridBox& map, const GridBox& ground) {
  const double margin = 0.5 * std::hypot(footprint.width_m, footprint.height_m);
  const GridBox shared = intersection(map, ground);
  if (shared.empty()) {
    throw InvalidInput("no-place-to-fly",
                       "what lies below is no part of the map: take imagery and a map of one place (roadfix info says "
                       "where the map lies)");
  }
  const GridBox box = grown(shared, -margin);
  if (!box.empty()) return box;
  throw InvalidInput("no-place-to-fly",
                     "the footprint does not fit where map and imagery overlap: make it smaller with --footprint-m");
}

fly::Flights simulated_flights(const FlyOptions& options, const MapView& map, const Ground& ground,
                               const fly::FlightPlan& plan, int number) {
  const GridBox box = flying_box(ground.footprint, map.extent, ground.box);
  const auto pilot = pilots_of(options, box, ground.course);
  return {[=, &ground](int, std::uint64_t seed, const std::function<void()>& seen) {
            return fly::fly(plan, box, *pilot(), *ground.sensor, seed, seen);
          },
          number, static_cast<std::int64_t>(number) * steps_of(options, ground.course, plan)};
}

fly::Flights recorded_flights(const Ground& ground, const fly::FlightPlan& plan, int number) {
  const auto recording_of = [&ground](int flight) -> const fly::Recording& {
    return ground.recordings[static_cast<std::size_t>(flight) % ground.recordings.size()];
  };
  std::int64_t steps = 0;
  for (int flight = 0; flight < number; ++flight) steps += std::ssize(recording_of(flight).frames);
  return {[=](int flight, std::uint64_t seed, const std::function<void()>& seen) {
            return fly::replay(recording_of(flight), plan, seed, seen);
          },
          number, steps};
}

int frames_of_the_longest(const std::vector<fly::Recording>& recordings) {
  std::size_t frames = 0;
  for (const fly::Recording& recording : recordings) frames = std::max(frames, recording.frames.size());
  return static_cast<int>(frames);
}

IndexRange outage_of(const FlyOptions& options, int steps) {
  const IndexRange outage{options.outage[0], options.outage[1]};
  if (outage.first < std::min(outage.end, steps)) return outage;
  throw InvalidInput("bad-parameter",
                     fmt::format("--outage {},{} leaves out no frame: FIRST comes before END, and before "
                                 "the flight's {} steps are over",
                                 outage.first, outage.end, steps));
}

fly::Kidnapping kidnapping_of(const FlyOptions& options, int steps) {
  const double step = options.kidnap[0];
  if (step != std::floor(step)) {
    throw InvalidInput("bad-parameter",
                       fmt::format("--kidnap at step {} lies between two steps: give a whole number", step));
  }
  const fly::Kidnapping kidnapping{static_cast<int>(step), options.kidnap[1]};
  if (kidnapping.step < steps) return kidnapping;
  throw InvalidInput("bad-parameter",
                     fmt::format("--kidnap at step {} comes after the flight, whose {} steps count from 0: give more "
                                 "with --steps",
                                 kidnapping.step, steps));
}

fly::LevelFlight level_flight_of(const FlyOptions& options, const MapView& map, const Ground& ground) {
  if (!ground.recordings.empty() || !options.service.base.empty()) {
    throw InvalidInput("option-without-effect",
                       "--alt is for simulated flights that the library follows: leave it out");
  }
  if (!(options.camera.agl_m > 0.0)) {
    throw InvalidInput("bad-parameter",
                       "--agl 0 with --alt: a frame would show --footprint-m from the ground; give a height above 0");
  }
  required_agl_m(map, ground.box, *options.alt_m);
  return {map.terrain, *options.alt_m, options.camera.agl_m, options.tells_alt};
}

}  // namespace

MapView map_of(const FlyOptions& options) {
  constexpr std::size_t kSearchCacheBytes = std::size_t{1} << 30;  // all flights search the same map
  MapView map = view_with_notes(options.map, kSearchCacheBytes);
  return options.area_m > 0.0 ? fly::middle_of(map, options.area_m) : map;
}

Ground ground_of(const FlyOptions& options, const MapView& map) {
  const std::string kind = lower_case(std::filesystem::path(options.over).extension().string());
  const bool over_a_map = options.over.empty() || kind == ".gpkg";
  const bool sends_frames = options.send == "frames";
  if (sends_frames) require_sendable_frames(options, !over_a_map);
  if (options.border == Border::kBlackUnseen && kind != ".csv") {
    throw InvalidInput("option-without-effect",
                       "--black-unseen is about recorded flights: name one with --over, or leave it out");
  }
  Ground ground;
  ground.footprint = options.footprint;
  ground.course = kind == ".csv" ? std::vector<GridPoint>() : course_of(options, map.zone);
  if (over_a_map) {
    look_at_map(options, map, ground);
    return ground;
  }
  if (!sends_frames) ground.detector = detector_for(map, options.detector);
  if (kind == ".csv") {
    look_at_recordings(options, map, ground);
    note_frames_beyond(map, ground, options);
  } else {
    look_at_imagery(options, map, ground);
  }
  ground.what = fmt::format("frames of {}, {}", options.over,
                            sends_frames ? "roads detected by the service" : ground.detector->describe());
  return ground;
}

fly::FlightPlan plan_of(const FlyOptions& options, const MapView& map, const Ground& ground) {
  fly::FlightPlan plan = options.plan;
  plan.steps = options.steps.value_or(ground.course.empty() ? plan.steps : kMostSteps);
  plan.registration_m =
      options.registration_m.value_or(ground.imagery ? 0.0 : map.registration_sigma_m(map.extent.centre()));
  const int steps =
      ground.recordings.empty() ? steps_of(options, ground.course, plan) : frames_of_the_longest(ground.recordings);
  if (!options.outage.empty()) plan.outage = outage_of(options, steps);
  if (!options.kidnap.empty()) plan.kidnapping = kidnapping_of(options, steps);
  if (options.alt_m) plan.level = level_flight_of(options, map, ground);
  return plan;
}

fly::Flights flights_of(const FlyOptions& options, const MapView& map, const Ground& ground,
                        const fly::FlightPlan& plan) {
  const int recordings = static_cast<int>(ground.recordings.size());
  const int number = options.vehicles > 0 ? options.vehicles : options.runs * std::max(1, recordings);
  return recordings > 0 ? recorded_flights(ground, plan, number)
                        : simulated_flights(options, map, ground, plan, number);
}

VehicleNoise vehicle_of(const FlyOptions& options) {
  VehicleNoise vehicle = options.service.filter.vehicle;
  if (options.plan.tells_odometry) return vehicle;
  const fly::Handling& handling = options.plan.handling;
  vehicle.planar =
      VehicleNoise::Planar{{handling.speed_m_s, 0.1 * handling.speed_m_s}, {0.0, 0.5 * handling.turn_rate.radians()}};
  return vehicle;
}

}  // namespace roadfix::cli
