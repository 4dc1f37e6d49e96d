#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "cli/command.hpp"
#include "cli/detector_options.hpp"
#include "cli/fly/area.hpp"
#include "cli/fly/campaign.hpp"
#include "cli/fly/flight_files.hpp"
#include "cli/fly/screening.hpp"
#include "cli/terminal.hpp"
#include "core/units/error.hpp"
#include "tiles/sources/read_orthoimage.hpp"
#include "tiles/view/map_file_view.hpp"

namespace roadfix::cli {
namespace {

using nlohmann::json;

struct Options {
  std::string map;
  std::string over;
  std::string course = "random";
  double lane_m = 300.0;
  double area_m = 0.0;
  std::vector<double> footprint_m{400.0};
  fly::FlightPlan plan;
  double turn_rate_deg = 10.0;
  double turn_noise_deg = 0.3;
  double turn_drift_deg = 0.05;
  bool no_odometry = false;
  std::vector<int> outage;
  std::vector<double> kidnap;
  double attitude_deg = 1.0;
  fly::CameraErrors camera;
  FeatureQuality quality{0.2, 0.2, 0.0, 2.0, 0.0, 0.0};
  DetectorChoice detector;
  std::vector<std::string> filters{"default"};
  int particles = 10'000;
  int measure_every = 1;
  int runs = 1;
  std::uint64_t seed = 1;
  int jobs = 1;
  std::string json_file;
  std::string csv_file;
  std::string geojson_file;
  fly::ScreeningOptions screening;
};

/// The ground that the vehicle looks at, whichever it is.
struct Ground {
  std::optional<Orthoimage> imagery;
  std::unique_ptr<RoadDetector> detector;
  std::unique_ptr<fly::Sensor> sensor;
  GridBox box;
  std::string what;
};

Footprint footprint_of(const Options& options) { return {options.footprint_m.front(), options.footprint_m.back()}; }

fly::FlightPlan plan_of(const Options& options) {
  fly::FlightPlan plan = options.plan;
  plan.handling.turn_rate = Angle::degrees(options.turn_rate_deg);
  plan.odometry.turn = Angle::degrees(options.turn_noise_deg);
  plan.odometry.turn_drift = Angle::degrees(options.turn_drift_deg);
  plan.tells_odometry = !options.no_odometry;
  if (!options.outage.empty()) plan.outage = fly::StepRange{options.outage[0], options.outage[1]};
  if (!options.kidnap.empty()) {
    plan.kidnapping = fly::Kidnapping{static_cast<int>(options.kidnap[0]), options.kidnap[1]};
  }
  return plan;
}

Ground ground_of(const Options& options, const MapView& map) {
  Ground ground;
  const Footprint footprint = footprint_of(options);
  if (options.over.empty() || std::filesystem::path(options.over).extension() == ".gpkg") {
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
  ground.detector = make_detector(options.detector);
  ground.imagery = read_orthoimage(options.over, map.zone);
  fly::CameraErrors errors = options.camera;
  errors.attitude = Angle::degrees(options.attitude_deg);
  ground.sensor = fly::make_imaging_sensor(*ground.imagery, *ground.detector, footprint, errors, map.cell_m);
  ground.box = ground.imagery->box();
  ground.what = fmt::format("frames of {}, {}", options.over, ground.detector->describe());
  return ground;
}

/// Where the whole footprint lies on the map and on what is flown over, whatever the heading.
GridBox flying_box(const Options& options, const MapView& map, const GridBox& ground) {
  const Footprint footprint = footprint_of(options);
  const double margin = 0.5 * std::hypot(footprint.width_m, footprint.height_m);
  const GridBox box{{std::max(map.extent.min.east_m, ground.min.east_m) + margin,
                     std::max(map.extent.min.north_m, ground.min.north_m) + margin},
                    {std::min(map.extent.max.east_m, ground.max.east_m) - margin,
                     std::min(map.extent.max.north_m, ground.max.north_m) - margin}};
  if (!box.empty()) return box;
  throw InvalidInput("no-place-to-fly",
                     "the footprint does not fit where map and imagery overlap: make it smaller with --footprint-m");
}

std::function<std::unique_ptr<fly::Pilot>()> pilots_of(const Options& options, const GridBox& box,
                                                       const UtmZone& zone) {
  const fly::Handling handling = plan_of(options).handling;
  if (options.course == "random") return [=] { return fly::make_random_pilot(box, handling); };
  const auto points =
      options.course == "survey" ? fly::survey_lanes(box, options.lane_m) : fly::read_waypoints(options.course, zone);
  return [=] { return fly::make_waypoint_pilot(points, handling); };
}

VehicleNoise vehicle_of(const Options& options) {
  VehicleNoise vehicle;
  if (!options.no_odometry) return vehicle;
  const fly::Handling handling = plan_of(options).handling;
  vehicle.planar =
      VehicleNoise::Planar{{handling.speed_m_s, 0.1 * handling.speed_m_s}, {0.0, 0.5 * handling.turn_rate.radians()}};
  return vehicle;
}

void write_text(const std::string& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.close();
  if (!out) throw IoFailure("result-unwritable", fmt::format("{} cannot be written", file));
}

json run_json(const fly::Run& run) {
  const auto found = fly::found_at(run.records);
  return {{"seed", run.seed},
          {"steps", run.records.size()},
          {"found_at_step", found ? json(run.records[*found].sequence) : json()},
          {"final_error_m", run.records.empty() ? json() : json(run.records.back().error_m)}};
}

json document(const Options& options, const Ground& ground, const std::vector<fly::FilterRuns>& results,
              const fly::Events& events) {
  json filters = json::object();
  for (const auto& result : results) {
    json summary = to_json(fly::summary_of(result.runs, events));
    summary["flights"] = json::array();
    for (const fly::Run& run : result.runs) summary["flights"].push_back(run_json(run));
    filters[result.filter] = std::move(summary);
  }
  return {{"roadfix", ROADFIX_VERSION},
          {"map", options.map},
          {"ground", ground.what},
          {"seed", options.seed},
          {"particles", options.particles},
          {"footprint_m", options.footprint_m},
          {"filters", filters}};
}

void write_files(const Options& options, const std::vector<fly::FilterRuns>& results, const UtmZone& zone) {
  if (!options.csv_file.empty()) {
    std::string text = fly::csv_header();
    for (const auto& result : results) {
      for (const fly::Run& run : result.runs) text += fly::csv_lines(result.filter, run, zone);
    }
    write_text(options.csv_file, text);
  }
  if (options.geojson_file.empty()) return;
  json features = json::array();
  for (const auto& result : results) {
    for (const fly::Run& run : result.runs) {
      for (auto& feature : fly::geojson_features(result.filter, run, zone)) features.push_back(std::move(feature));
    }
  }
  write_text(options.geojson_file, json{{"type", "FeatureCollection"}, {"features", features}}.dump());
}

MapView map_of(const Options& options) {
  const auto reader = std::make_shared<const MapReader>(options.map);
  MapView map = view_of(reader, std::filesystem::path(options.map).stem().string());
  return options.area_m > 0.0 ? fly::middle_of(map, options.area_m) : map;
}

void run_fly(const Options& options) {
  const MapView map = map_of(options);
  const Ground ground = ground_of(options, map);
  for (const std::string& filter : options.filters) fly::filter_named(filter, options.particles);
  fly::Screening screening(map, ground.imagery ? &*ground.imagery : nullptr, footprint_of(options), options.screening);
  fly::Campaign campaign;
  campaign.plan = plan_of(options);
  campaign.box = flying_box(options, map, ground.box);
  campaign.pilot = pilots_of(options, campaign.box, map.zone);
  campaign.sensor = ground.sensor.get();
  campaign.stop = stop_on_signals();
  campaign.localizer =
      fly::library_localizers(map, options.particles, options.measure_every, vehicle_of(options), campaign.stop);
  campaign.filters = options.filters;
  campaign.runs = options.runs;
  campaign.seed = options.seed;
  campaign.jobs = options.jobs;
  campaign.watch = [&](const std::string& filter, const fly::Record& record, const fly::Localizer& localizer) {
    screening.show(filter, record, localizer);
  };
  Progress progress("flying", "steps");
  campaign.progress = [&](std::int64_t done, std::int64_t total) { progress.update(done, total); };
  const auto results = fly::run(campaign, map.zone);
  screening.finish();
  const fly::Events events{campaign.plan.kidnapping, campaign.plan.outage};
  std::vector<std::pair<std::string, fly::Summary>> summaries;
  for (const auto& result : results) summaries.emplace_back(result.filter, fly::summary_of(result.runs, events));
  fmt::print("{}\nseed {}, {:.1f} x {:.1f} km of map\n{}", ground.what, options.seed, map.extent.width_m() / 1e3,
             map.extent.height_m() / 1e3, fly::to_table(summaries, events));
  write_files(options, results, map.zone);
  if (!options.json_file.empty()) {
    write_text(options.json_file, document(options, ground, results, events).dump(1) + '\n');
  }
}

void add_flight_options(CLI::App& command, Options& o) {
  constexpr const char* kGroup = "Flight";
  const auto add = [&](const char* name, auto& value, const char* what) {
    return command.add_option(name, value, what)->capture_default_str()->group(kGroup);
  };
  add("--course", o.course, "random, survey, or a GeoJSON file of waypoints")->type_name("COURSE");
  add("--lane-m", o.lane_m, "Distance between the lanes of a survey")->check(CLI::PositiveNumber);
  add("--area-m", o.area_m, "Only the square of this side in the middle of the map; 0 = all")
      ->check(CLI::NonNegativeNumber);
  add("--steps", o.plan.steps, "Steps of a flight, at most")->check(CLI::Range(1, 100'000));
  add("--step-s", o.plan.handling.step_s, "Seconds between steps")->check(CLI::PositiveNumber);
  add("--speed", o.plan.handling.speed_m_s, "Metres per second")->check(CLI::NonNegativeNumber);
  add("--turn-rate", o.turn_rate_deg, "Fastest turn in degrees per second")->check(CLI::NonNegativeNumber);
  add("--footprint-m", o.footprint_m, "Ground that a frame shows: side, or width,height")
      ->delimiter(',')
      ->expected(1, 2)
      ->check(CLI::PositiveNumber);
  add("--frame-every", o.plan.frame_every, "A frame in every k-th step")->check(CLI::PositiveNumber);
  add("--missing", o.plan.missing_share, "Share of frames that are lost, at random")->check(CLI::Range(0.0, 1.0));
  add("--outage", o.outage, "No frames from step FIRST to before step END")
      ->delimiter(',')
      ->expected(2)
      ->type_name("FIRST,END")
      ->check(CLI::NonNegativeNumber);
  add("--kidnap", o.kidnap, "At this step the vehicle is METRES away, unnoticed by its odometry")
      ->delimiter(',')
      ->expected(2)
      ->type_name("STEP,METRES")
      ->check(CLI::PositiveNumber);
}

void add_error_options(CLI::App& command, Options& o) {
  constexpr const char* kGroup = "Errors (1 sigma)";
  const auto add = [&](const char* name, double& value, const char* what) {
    command.add_option(name, value, what)->capture_default_str()->group(kGroup)->check(CLI::NonNegativeNumber);
  };
  add("--odometry-noise", o.plan.odometry.share, "Odometry: share of the distance, each step and axis");
  add("--odometry-scale", o.plan.odometry.scale, "Odometry: scale, once for a flight");
  add("--turn-noise", o.turn_noise_deg, "Odometry: degrees of each step's turn");
  add("--turn-drift", o.turn_drift_deg, "Odometry: degrees per second, once for a flight");
  add("--attitude", o.attitude_deg, "Imagery: degrees of roll and pitch not known to the rectification");
  add("--altitude", o.camera.altitude, "Imagery: relative error of the altitude");
  add("--agl", o.camera.agl_m, "Imagery: metres above ground, by which attitude moves what is seen");
  add("--erase", o.quality.erase, "Feature maps: share of the road that is missing");
  add("--invent", o.quality.invent, "Feature maps: roads that are not there, as a share of the true ones");
  add("--block", o.quality.block, "Feature maps: share of the footprint that is not observed");
  add("--shift", o.quality.shift_m, "Feature maps: metres of shift per axis");
  add("--scale", o.quality.scale, "Feature maps: relative error of their size");
  add("--tilt", o.quality.tilt_deg, "Feature maps: degrees of tilt per axis");
  command.add_flag("--no-odometry", o.no_odometry, "Tell no odometry: equation (4) with known speed, unknown turns")
      ->group(kGroup);
}

void add_output_options(CLI::App& command, Options& o) {
  constexpr const char* kGroup = "Output";
  const auto add = [&](const char* name, auto& value, const char* what) {
    return command.add_option(name, value, what)->group(kGroup);
  };
  add("--json", o.json_file, "Figures of every filter")->type_name("FILE");
  add("--csv", o.csv_file, "Truth, estimate and covariance of every step")->type_name("FILE");
  add("--geojson", o.geojson_file, "True paths, estimated paths, ellipses")->type_name("FILE");
  add("--pictures", o.screening.folder, "Draw steps of the first flight into this folder")->type_name("DIR");
  add("--picture-steps", o.screening.steps, "Which steps; default: 0,1,5,20,80 and the last")->delimiter(',');
  add("--film", o.screening.film, "The first flight as an animated GIF, filters side by side")->type_name("FILE");
  add("--film-rate", o.screening.frames_per_second, "Steps per second of the film")
      ->capture_default_str()
      ->check(CLI::Range(1, 50));
  add("--picture-px", o.screening.longest_px, "Longer side of a picture")
      ->capture_default_str()
      ->check(CLI::Range(100, 8000));
}

}  // namespace

void add_fly_command(CLI::App& app) {
  auto* command = app.add_subcommand("fly", "Flies simulated UAVs over imagery or a map and follows them on the map");
  command->footer(
      "Examples: roadfix fly town.gpkg --over post.tif --filter paper,default --pictures figures\n"
      "          roadfix fly city.gpkg --runs 100 --erase 0.3 --kidnap 100,2000 --json out.json");
  const auto o = std::make_shared<Options>();
  command->add_option("map", o->map, "Map file (GeoPackage) to localize on")->required();
  command->add_option(
      "--over", o->over,
      "What lies below: georeferenced imagery, or another map; default: the map itself, as feature maps "
      "with errors");
  command
      ->add_option("--filter", o->filters,
                   std::string("One or more of ") + fly::kFilterNames + ", over the same flights")
      ->delimiter(',')
      ->capture_default_str();
  command->add_option("--particles", o->particles, "At most")->capture_default_str()->check(CLI::Range(10, 1'000'000));
  command->add_option("--measure-every", o->measure_every, "Weight by every k-th frame only")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command->add_option("--runs", o->runs, "Flights, with seeds that count up")
      ->capture_default_str()
      ->check(CLI::Range(1, 100'000));
  command->add_option("--seed", o->seed, "Of the first flight")->capture_default_str();
  o->jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  command->add_option("--jobs", o->jobs, "Flights at a time; results do not depend on it")
      ->capture_default_str()
      ->check(CLI::Range(1, 1024));
  add_flight_options(*command, *o);
  add_error_options(*command, *o);
  add_output_options(*command, *o);
  add_detector_options(*command, o->detector);
  command->callback([o] { run_fly(*o); });
}

}  // namespace roadfix::cli
