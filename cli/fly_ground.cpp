#include "cli/fly_ground.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "cli/fly/area.hpp"
#include "core/units/error.hpp"
#include "tiles/sources/read_orthoimage.hpp"
#include "tiles/view/map_file_view.hpp"

namespace roadfix::cli {
namespace {

fly::Handling handling_of(const FlyOptions& options) {
  fly::Handling handling = options.plan.handling;
  handling.turn_rate = Angle::degrees(options.turn_rate_deg);
  return handling;
}

void require_sendable_frames(const FlyOptions& options, bool over_imagery) {
  if (options.server.empty()) {
    throw InvalidInput("frames-without-service",
                       "--send frames leaves it to a service to detect roads: name it with --server");
  }
  if (!over_imagery) {
    throw InvalidInput("no-frames-to-send",
                       "a map shows roads and no pictures: name imagery with --over, or leave out --send frames");
  }
  if (options.detector.name != "auto" || !options.detector.model.empty() || options.detector.orientations != 1) {
    throw InvalidInput("detector-elsewhere",
                       "with --send frames the service detects roads by its own detector: give --detector, --model and "
                       "--orientations to roadfix serve");
  }
}

fly::CameraErrors camera_errors_of(const FlyOptions& options) {
  fly::CameraErrors errors = options.camera;
  errors.attitude = Angle::degrees(options.attitude_deg);
  return errors;
}

}  // namespace

MapView map_of(const FlyOptions& options) {
  const auto reader = std::make_shared<const MapReader>(options.map);
  constexpr std::size_t kSearchCacheBytes = std::size_t{1} << 30;  // all flights search the same map
  MapView map = view_of(reader, std::filesystem::path(options.map).stem().string(), kSearchCacheBytes);
  return options.area_m > 0.0 ? fly::middle_of(map, options.area_m) : map;
}

Footprint footprint_of(const FlyOptions& options) { return {options.footprint_m.front(), options.footprint_m.back()}; }

Ground ground_of(const FlyOptions& options, const MapView& map) {
  Ground ground;
  const Footprint footprint = footprint_of(options);
  const bool over_imagery = !options.over.empty() && std::filesystem::path(options.over).extension() != ".gpkg";
  const bool sends_frames = options.send == "frames";
  if (sends_frames) require_sendable_frames(options, over_imagery);
  if (!over_imagery) {
    const bool itself = options.over.empty();
    const MapView from = itself ? map : view_of(std::make_shared<const MapReader>(options.over), options.over);
    if (!(from.zone == map.zone)) {
      throw InvalidInput(
          "map-of-another-zone",
          fmt::format("{} lies in another UTM zone than {}: take maps of one place", options.over, options.map));
    }
    ground.sensor = fly::make_simulated_sensor(from, footprint, options.quality);
    ground.box = from.extent;
    ground.what = fmt::format("feature maps cut out of {}", itself ? options.map : options.over);
    return ground;
  }
  if (!sends_frames) ground.detector = make_detector(options.detector);
  ground.imagery = read_orthoimage(options.over, map.zone);
  ground.box = ground.imagery->box();
  const fly::CameraErrors errors = camera_errors_of(options);
  if (sends_frames) {
    ground.sensor = fly::make_camera(*ground.imagery, footprint, errors, map.cell_m);
    ground.what = fmt::format("frames of {}, roads detected by the service", options.over);
  } else {
    ground.sensor = fly::make_imaging_sensor(*ground.imagery, *ground.detector, footprint, errors, map.cell_m);
    ground.what = fmt::format("frames of {}, {}", options.over, ground.detector->describe());
  }
  return ground;
}

fly::FlightPlan plan_of(const FlyOptions& options, const MapView& map, const Ground& ground) {
  fly::FlightPlan plan = options.plan;
  plan.handling = handling_of(options);
  plan.odometry.turn = Angle::degrees(options.turn_noise_deg);
  plan.odometry.turn_drift = Angle::degrees(options.turn_drift_deg);
  plan.tells_odometry = !options.no_odometry;
  plan.registration_m = options.registration_m.value_or(ground.imagery ? 0.0 : map.registration_sigma_m);
  if (!options.outage.empty()) plan.outage = fly::StepRange{options.outage[0], options.outage[1]};
  if (!options.kidnap.empty()) {
    plan.kidnapping = fly::Kidnapping{static_cast<int>(options.kidnap[0]), options.kidnap[1]};
  }
  return plan;
}

GridBox flying_box(const FlyOptions& options, const MapView& map, const GridBox& ground) {
  const Footprint footprint = footprint_of(options);
  const double margin = 0.5 * std::hypot(footprint.width_m, footprint.height_m);
  const GridBox box = grown(intersection(map.extent, ground), -margin);
  if (!box.empty()) return box;
  throw InvalidInput("no-place-to-fly",
                     "the footprint does not fit where map and imagery overlap: make it smaller with --footprint-m");
}

std::function<std::unique_ptr<fly::Pilot>()> pilots_of(const FlyOptions& options, const GridBox& box,
                                                       const UtmZone& zone) {
  const fly::Handling handling = handling_of(options);
  if (options.course == "random") return [=] { return fly::make_random_pilot(box, handling); };
  const auto points =
      options.course == "survey" ? fly::survey_lanes(box, options.lane_m) : fly::read_waypoints(options.course, zone);
  return [=] { return fly::make_waypoint_pilot(points, handling); };
}

VehicleNoise vehicle_of(const FlyOptions& options) {
  VehicleNoise vehicle;
  if (!options.no_odometry) return vehicle;
  const fly::Handling handling = handling_of(options);
  vehicle.planar =
      VehicleNoise::Planar{{handling.speed_m_s, 0.1 * handling.speed_m_s}, {0.0, 0.5 * handling.turn_rate.radians()}};
  return vehicle;
}

}  // namespace roadfix::cli
