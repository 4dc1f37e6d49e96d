#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "cli/boresight/boresight_flight.hpp"
#include "cli/boresight/boresight_report.hpp"
#include "cli/calibration_option.hpp"
#include "cli/command.hpp"
#include "cli/detector_options.hpp"
#include "cli/map_notes.hpp"
#include "cli/number_checks.hpp"
#include "cli/picture_files.hpp"
#include "cli/terminal.hpp"
#include "cli/threads_option.hpp"
#include "cli/unit_options.hpp"
#include "core/units/error.hpp"
#include "core/units/json_text.hpp"

namespace roadfix::cli {
namespace {

struct BoresightArguments {
  std::string map;
  std::string csv;
  LookOptions look;
  BoresightPrior prior{.place_sigma_m = 2.0};
  Attitude mounted;
  DetectorChoice detector;
  std::string calibration;
  bool as_json = false;
};

std::vector<BoresightSighting> sightings_of(const Flight& flight) {
  std::vector<BoresightSighting> sightings;
  for (const FlightFrame& frame : flight.frames) {
    if (frame.sighting) sightings.push_back(*frame.sighting);
  }
  return sightings;
}

void require_enough(const std::vector<BoresightSighting>& sightings, const Flight& flight, double radius_m) {
  if (sightings.size() >= kFewestSightings) return;
  throw InvalidInput(
      "boresight-too-few",
      fmt::format("{} of {} frames were found within {:g} m of where they were told to be taken, and at least {} are "
                  "needed: check heights, field of view and heading of the table, and that its frames show 300 m of "
                  "roads or more of this map; --radius, --heading-range and --scale-range allow for larger errors",
                  sightings.size(), flight.frames.size(), radius_m, kFewestSightings));
}

Flight flight_of(const BoresightArguments& arguments, const MapView& map) {
  LookOptions look = arguments.look;
  if (!arguments.calibration.empty()) look.fix.calibration = read_calibration(arguments.calibration);
  look.fix.search.deadline = Deadline(stop_on_signals());
  const auto detector = detector_for(map, arguments.detector);
  Progress progress("locating", "frames");
  return look_for(arguments.csv, map, *detector, look, progress.updates());
}

void run_boresight(const BoresightArguments& arguments) {
  constexpr std::size_t kSearchCacheBytes = std::size_t{512} << 20;  // frames search the ground of their neighbours
  const MapView map = view_with_notes(arguments.map, kSearchCacheBytes);
  BoresightReport report{map.id, arguments.csv, flight_of(arguments, map), {}, arguments.mounted};
  for (const LeftOutFrame& frame : report.flight.left_out) say_left_out(frame.file, frame.reason);
  const std::vector<BoresightSighting> sightings = sightings_of(report.flight);
  require_enough(sightings, report.flight, arguments.look.radius_m);
  BoresightPrior prior = arguments.prior;
  prior.place_sigma_m = std::hypot(prior.place_sigma_m, report.flight.registration_sigma_m);
  report.found = boresight_of(sightings, prior);
  fmt::print("{}", arguments.as_json ? json_text(boresight_json(report), 2) + "\n" : boresight_text(report));
  require_none(report.flight.left_out.size(), report.flight.frames.size());
}

}  // namespace

void add_boresight_command(CLI::App& app) {
  auto* command = app.add_subcommand(
      "boresight", "Says how a camera is turned against what is told of it, from a flight with GPS over a map");
  command->footer(
      "The table is that of bench and fly: `roadfix frames` makes it of a drone's photos, scripts/mavlink_steps --csv "
      "of "
      "a flight. Fly over streets, with several headings.\n"
      "Exit code: 0 done, 1 where too few frames were found or one could not be read, 2 for wrong usage.\n"
      "Examples: roadfix boresight city.gpkg frames.csv\n"
      "          roadfix boresight city.gpkg frames.csv --mounted 90,0,0      (mavlink_steps had --camera-yaw 90)");
  const auto a = std::make_shared<BoresightArguments>();
  command->add_option("map", a->map, "Map file (GeoPackage)")->required();
  command->add_option("frames", a->csv, "Table of frames (CSV) with the places that GPS told")->required();
  command->add_option("--radius,--radius-m", a->look.radius_m, "Look so many metres around each told place")
      ->check(positive(2000.0))
      ->capture_default_str();
  add_degrees_option(*command, "--heading-range", a->look.heading_range,
                     "Look so many degrees to both sides of each told heading (default: 20)")
      ->check(between(0.0, 180.0));
  a->look.fix.search.scale_range = 0.1;
  command
      ->add_option("--scale-range", a->look.fix.search.scale_range,
                   "Ground may be so much smaller or larger than told, as a share")
      ->check(between(0.0, kMaxScaleRange))
      ->capture_default_str();
  a->look.fix.confidence = 0.9;
  command
      ->add_option("--confidence", a->look.fix.confidence,
                   "Least probability of a place; those elsewhere are left out afterwards")
      ->check(between(0.5, 1.0))
      ->capture_default_str();
  command
      ->add_option(
          "--place-sigma", a->prior.place_sigma_m,
          "How far off the told places of the whole flight may be, 1 sigma per axis in metres, beside what the "
          "map states of itself")
      ->check(positive(1000.0))
      ->capture_default_str();
  command
      ->add_option("--delay-sigma", a->prior.delay_sigma_s,
                   "How much before or after its time a picture may have been taken, 1 sigma in seconds")
      ->check(positive(10.0))
      ->capture_default_str();
  command
      ->add_option_function<std::vector<double>>(
          "--mounted",
          [a](const std::vector<double>& degrees) {
            a->mounted = {Angle::degrees(degrees[0]), Angle::degrees(degrees[1]), Angle::degrees(degrees[2])};
          },
          "Mount of the camera that counted already when the flight was recorded: what is printed for mavlink_steps is "
          "then that and what was found")
      ->type_name("YAW,PITCH,ROLL")
      ->delimiter(',')
      ->expected(3)
      ->check(between(-360.0, 360.0));
  add_calibration_option(*command, a->calibration);
  add_detector_options(*command, a->detector);
  add_threads_option(*command, "--threads", a->look.fix.search.threads, "Threads of a search");
  command->add_flag("--json", a->as_json, "Answer in JSON");
  command->callback([a] { run_boresight(*a); });
}

}  // namespace roadfix::cli
