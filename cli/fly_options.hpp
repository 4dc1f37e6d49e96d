// What `roadfix fly` is asked for.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/detector_options.hpp"
#include "cli/fly/flight.hpp"
#include "cli/fly/flight_pictures.hpp"
#include "cli/fly/sensor.hpp"

namespace roadfix::cli {

struct FlyOptions {
  std::string map;
  std::string over;
  bool black_unseen = false;
  std::string course = "random";
  double lane_m = 300.0;
  double area_m = 0.0;
  std::vector<double> footprint_m{400.0};
  fly::FlightPlan plan;
  std::optional<int> steps;  ///< default: those of the plan; of a recorded flight all
  std::optional<double> wind_sigma_m_s;
  std::optional<double> wind_walk;
  double scale_range = 0.0;
  bool no_odometry = false;
  std::vector<int> outage;               ///< first step without frames and the first with them again; empty = none
  std::vector<double> kidnap;            ///< step and metres; empty = none
  std::optional<double> registration_m;  ///< default: what the map says of itself
  fly::CameraErrors camera;
  FeatureQuality quality{0.2, 0.2, 0.0, 2.0, 0.0, 0.0};
  DetectorChoice detector;
  std::vector<std::string> filters{"default"};
  int particles = 10'000;
  int measure_every = 1;
  int runs = 1;
  std::uint64_t seed = 1;
  int jobs = 1;
  std::string server;
  std::string served_map;
  std::string send = "features";
  int vehicles = 0;
  int patience_s = 60;
  bool keep_tracks = false;
  std::string json_file;
  std::string csv_file;
  std::string geojson_file;
  fly::FlightPictureOptions pictures;
};

void add_fly_options(CLI::App& command, FlyOptions& options);

}  // namespace roadfix::cli
