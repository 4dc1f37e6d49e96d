#include "cli/fly/fly_options.hpp"

#include <fmt/format.h>

#include <chrono>

#include "cli/number_checks.hpp"
#include "cli/threads_option.hpp"
#include "cli/unit_options.hpp"
#include "server/api/position_answer.hpp"

namespace roadfix::cli {
namespace {

CLI::Option* add_angle(CLI::App& command, const char* name, Angle& angle, const char* what) {
  return add_degrees_option(command, name, angle, what)
      ->default_str(fmt::format("{:g}", angle.degrees()))
      ->check(not_negative());
}

void add_basics(CLI::App& command, FlyOptions& o) {
  fly::FilterPlan& filter = o.service.filter;
  // Not "map": later versions of CLI11 take that for --map.
  command.add_option("map_file", o.map, "Map file (GeoPackage) to localize on")->required();
  command.add_option(
      "--over", o.over,
      "What lies below: georeferenced imagery; another map; or FRAMES.csv, a recorded flight with its "
      "true poses, one for each sequence (columns as of the frames of roadfix bench, and time_s); default: "
      "the map itself, as feature maps with errors");
  command.add_flag_callback(
      "--black-unseen", [&o] { o.border = Border::kBlackUnseen; },
      "Recorded flights: black areas at the rim of a frame were not seen");
  command
      .add_option("--filter", o.campaign.filters,
                  std::string("One or more of ") + fly::kFilterNames + ", over the same flights")
      ->delimiter(',')
      ->capture_default_str();
  command.add_option("--particles", filter.particles, "Maximum number of particles of a filter")
      ->capture_default_str()
      ->check(CLI::Range(10, 1'000'000));
  command
      .add_option("--runs", o.runs, "Flights, with seeds that count up; of a recorded flight so many of each sequence")
      ->capture_default_str()
      ->check(CLI::Range(1, 100'000));
  command.add_option("--seed", o.campaign.seed, "Random seed of the first flight; the next ones count up")
      ->capture_default_str()
      ->check(seed());
  add_threads_option(command, "--jobs", o.campaign.jobs, "Flights at a time; results do not depend on it");
}

void add_belief_options(CLI::App& command, FlyOptions& o) {
  constexpr const char* kGroup = "What the filters take to be uncertain";
  command
      .add_option(
          "--start-radius", o.campaign.start.radius_m,
          "Metres: filters are told a circle of this radius that holds the start, anywhere in it; default: they "
          "know nothing of the start")
      ->group(kGroup)
      ->check(positive());
  command
      .add_option_function<double>(
          "--start-heading-range",
          [&o](double degrees) { o.campaign.start.heading_half_width = Angle::degrees(degrees); },
          "Degrees: they are told a heading of the start that is right to within so much")
      ->group(kGroup)
      ->check(between(0.0, 180.0));
  command
      .add_flag("--known-start", o.service.filter.start_is_known,
                "That circle (of 150 m at most) is certain: places need not be told apart beyond reach of it")
      ->group(kGroup)
      ->needs("--start-radius");
  command
      .add_option("--scale-range", o.service.filter.vehicle.scale_range,
                  "Lasting altitude error: the ground seen may be smaller or larger by this share")
      ->capture_default_str()
      ->group(kGroup)
      ->check(between(0.0, kMaxScaleRange));
  command
      .add_option("--wind-sigma", o.service.filter.vehicle.wind.sigma_m_s,
                  "The wind at first, where odometry is relative to the air: 1 sigma in metres per second and axis")
      ->capture_default_str()
      ->group(kGroup)
      ->check(between(0.0, 100.0));
}

void add_flight_options(CLI::App& command, FlyOptions& o) {
  constexpr const char* kGroup = "Flight";
  const auto add = [&](const char* name, auto& value, const char* what) {
    return command.add_option(name, value, what)->capture_default_str()->group(kGroup);
  };
  add("--course", o.course, "random, survey, or a file: a plan of QGroundControl, waypoints (QGC WPL) or GeoJSON")
      ->type_name("COURSE");
  add("--lane-m", o.lane_m, "Distance between the lanes of a survey")->check(between(1.0, kMaxNumber));
  add("--area-m", o.area_m,
      "Only the square of this side in the middle of the map, with --server as the bbox where tracks begin; 0 = all")
      ->check(not_negative());
  command
      .add_option("--steps", o.steps,
                  "Steps of a flight, at most; default: 100, of a course of a file and of a recorded flight all")
      ->group(kGroup)
      ->check(CLI::Range(1, kMostSteps));
  add("--step-s", o.plan.handling.step_s, "Seconds between steps; of a recorded flight where it has no times")
      ->check(between(0.001, kMaxNumber));
  add("--speed", o.plan.handling.speed_m_s, "Metres per second")->check(not_negative());
  add_angle(command, "--turn-rate", o.plan.handling.turn_rate, "Fastest turn in degrees per second")->group(kGroup);
  const auto show = [&o](const std::vector<double>& sides) { o.footprint = {sides.front(), sides.back()}; };
  command
      .add_option_function<std::vector<double>>("--footprint-m", show,
                                                "Ground that a frame shows: side, or width,height")
      ->default_str(fmt::format("[{:g}]", o.footprint.width_m))
      ->group(kGroup)
      ->delimiter(',')
      ->expected(1, 2)
      ->check(positive());
  command
      .add_option("--alt", o.alt_m,
                  "The vehicles keep this height above the sea over the ground of the map (roadfix terrain): a frame "
                  "shows --footprint-m where they are --agl above ground")
      ->group(kGroup)
      ->check(between(api::kAltitude.min, api::kAltitude.max));
  command
      .add_flag_callback(
          "--no-alt", [&o] { o.tells_alt = false; },
          "They are not told it, but that they are --agl above ground everywhere")
      ->group(kGroup)
      ->needs("--alt");
  add("--frame-every", o.plan.frame_every, "A frame in every k-th step")->check(positive());
  add("--missing", o.plan.missing_share, "Share of frames that are lost, at random")->check(between(0.0, 1.0));
  add("--outage", o.outage, "No frames from step FIRST to before step END")
      ->delimiter(',')
      ->expected(2)
      ->type_name("FIRST,END")
      ->check(not_negative());
  add("--kidnap", o.kidnap, "At this step the vehicle is METRES away, unnoticed by its odometry")
      ->delimiter(',')
      ->expected(2)
      ->type_name("STEP,METRES")
      ->check(positive());
}

void add_error_options(CLI::App& command, FlyOptions& o) {
  constexpr const char* kGroup = "Errors (1 sigma)";
  const auto add = [&](const char* name, double& value, const char* what, double max = kMaxNumber) {
    command.add_option(name, value, what)->capture_default_str()->group(kGroup)->check(not_negative(max));
  };
  add("--odometry-noise", o.plan.odometry.share, "Odometry: share of the distance, each step and axis");
  add("--odometry-scale", o.plan.odometry.scale, "Odometry: scale, once for a flight");
  add_angle(command, "--turn-noise", o.plan.odometry.turn, "Odometry: degrees of each step's turn")->group(kGroup);
  add_angle(command, "--turn-drift", o.plan.odometry.turn_drift, "Odometry: degrees per second, once for a flight")
      ->group(kGroup);
  add("--wind", o.plan.odometry.wind_m_s,
      "Odometry: metres per second and axis of a wind that it does not feel, once for a flight");
  add_angle(command, "--attitude", o.camera.attitude,
            "Imagery: degrees of roll and pitch not known to the rectification")
      ->group(kGroup);
  add("--altitude", o.camera.altitude, "Imagery: relative error of the altitude, in every frame");
  add("--altitude-bias", o.plan.altitude_bias,
      "Relative error of the altitude, once for a flight; recorded frames are as they are");
  add("--agl", o.camera.agl_m,
      "Imagery: metres above ground, by which attitude moves what is seen; with --alt also of feature maps");
  add("--erase", o.quality.erase, "Feature maps: share of the road that is missing", 1.0);
  add("--invent", o.quality.invent, "Feature maps: roads that are not there, as a share of the true ones");
  add("--block", o.quality.block, "Feature maps: share of the footprint that is not observed", 0.9);
  add("--shift", o.quality.shift_m, "Feature maps: metres of shift per axis, in every frame");
  add("--scale", o.quality.scale, "Feature maps: relative error of their size");
  add("--tilt", o.quality.tilt_deg, "Feature maps: degrees of tilt per axis");
  command
      .add_option("--registration", o.registration_m,
                  "Feature maps: metres per axis between ground and map, once for a flight; default: what the map says")
      ->check(not_negative())
      ->group(kGroup);
  command
      .add_flag_callback(
          "--no-odometry", [&o] { o.plan.tells_odometry = false; },
          "Tell no odometry: equation (4) with known speed, unknown turns")
      ->group(kGroup);
}

void add_output_options(CLI::App& command, FlyOptions& o) {
  constexpr const char* kGroup = "Output";
  const auto add = [&](const char* name, auto& value, const char* what) {
    return command.add_option(name, value, what)->group(kGroup);
  };
  add("--json", o.json_file, "Figures of every filter, and the options that were given")->type_name("FILE");
  add("--csv", o.csv_file, "Truth, estimate and covariance of every step")->type_name("FILE");
  add("--geojson", o.geojson_file, "True paths, estimated paths, ellipses")->type_name("FILE");
  add("--pictures", o.pictures.folder, "Draw steps of the first flight into this folder")->type_name("DIR");
  add("--picture-steps", o.pictures.steps, "Which steps; default: 0,1,5,20,80 and the last")
      ->delimiter(',')
      ->needs("--pictures");
  add("--film", o.pictures.film, "The first flight as an animated GIF, filters side by side")->type_name("FILE");
  add("--film-rate", o.pictures.frames_per_second, "Steps per second of the film")
      ->capture_default_str()
      ->needs("--film")
      ->check(CLI::Range(1, 50));
  add("--picture-px", o.pictures.longest_px, "Longer side of a picture")
      ->capture_default_str()
      ->check(CLI::Range(100, 8000));
}

void add_service_options(CLI::App& command, FlyOptions& o) {
  constexpr const char* kGroup = "Over a running service";
  command.add_option("--server", o.service.base, "http://HOST:PORT; the vehicles are followed by its tracks")
      ->type_name("URL")
      ->group(kGroup);
  command.add_option("--map", o.service.map, "The map's name there; default: that of the file")
      ->needs("--server")
      ->group(kGroup);
  command
      .add_option("--send", o.send,
                  "What the vehicles send: features, the roads that they detect themselves; frames, the pictures (as "
                  "PNG, without loss) in which the service detects roads by its own detector")
      ->capture_default_str()
      ->check(CLI::IsMember({"features", "frames"}))
      ->group(kGroup);
  command
      .add_option("--vehicles", o.vehicles, "Flights, all at the same time; default: --runs flights, --jobs at once")
      ->check(CLI::Range(1, 1024))
      ->group(kGroup);
  command
      .add_option_function<int>(
          "--patience", [&o](int seconds) { o.service.patience = std::chrono::seconds(seconds); },
          "Seconds in which a step is sent again when no answer comes")
      ->default_str(fmt::format("{}", o.service.patience.count()))
      ->needs("--server")
      ->check(CLI::Range(0, 86'400))
      ->group(kGroup);
  command.add_flag("--keep-tracks", o.service.keeps_tracks, "Leave the tracks in the service after the flights")
      ->needs("--server")
      ->group(kGroup);
}

}  // namespace

void add_fly_options(CLI::App& command, FlyOptions& options) {
  add_basics(command, options);
  add_flight_options(command, options);
  add_error_options(command, options);
  add_belief_options(command, options);
  add_service_options(command, options);
  add_output_options(command, options);
  add_detector_options(command, options.detector);
}

}  // namespace roadfix::cli
