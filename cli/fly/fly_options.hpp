// What `roadfix fly` is asked for.
#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/detector_options.hpp"
#include "cli/fly/campaign.hpp"
#include "cli/fly/flight_pictures.hpp"
#include "cli/fly/sensor.hpp"
#include "cli/fly/service_plan.hpp"
#include "core/detect/frame_image.hpp"

namespace roadfix::cli {

inline constexpr int kMostSteps = 100'000;  // of a flight

struct FlyOptions {
  nlohmann::json given;  ///< given_options()
  std::string map;
  std::string over;
  Border border = Border::kSeen;  ///< of the frames of a recorded flight
  std::string course = "random";
  double lane_m = 300.0;
  double area_m = 0.0;
  Footprint footprint{400.0, 400.0};
  fly::FlightPlan plan;
  std::optional<int> steps;              ///< default: those of the plan; of a course of a file or a recorded flight all
  std::vector<int> outage;               ///< first step without frames and the first with them again; empty = none
  std::vector<double> kidnap;            ///< step and metres; empty = none
  std::optional<double> registration_m;  ///< default: what the map says of itself
  fly::CameraErrors camera;
  FeatureQuality quality{.erase = 0.2, .invent = 0.2, .shift_m = 2.0};
  DetectorChoice detector;
  fly::Campaign campaign;
  int runs = 1;
  int vehicles = 0;          ///< at the same time, in place of runs and jobs; 0 = not given
  fly::ServicePlan service;  ///< without a base the library is told, by the same filters
  std::string send = "features";
  std::optional<double> alt_m;  ///< the vehicles keep this height above the sea
  bool tells_alt = true;
  std::string json_file;
  std::string csv_file;
  std::string geojson_file;
  fly::FlightPictureOptions pictures;
};

void add_fly_options(CLI::App& command, FlyOptions& options);

}  // namespace roadfix::cli
