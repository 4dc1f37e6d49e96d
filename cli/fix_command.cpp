#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "cli/bbox_option.hpp"
#include "cli/calibration_option.hpp"
#include "cli/command.hpp"
#include "cli/feature_input.hpp"
#include "cli/map_notes.hpp"
#include "cli/number_checks.hpp"
#include "cli/terminal.hpp"
#include "cli/threads_option.hpp"
#include "cli/unit_options.hpp"
#include "core/locate/fix.hpp"
#include "core/units/json_text.hpp"
#include "server/api/fix_json.hpp"

namespace roadfix::cli {
namespace {

struct FixArguments {
  std::string map;
  FeatureInputOptions input;
  double lat = 0.0;
  double lon = 0.0;
  double radius_m = 0.0;
  std::optional<GeoBox> bbox;
  std::optional<double> heading_deg;
  double heading_range_deg = 180.0;
  std::string calibration;
  FixOptions fix;
  bool as_json = false;
};

constexpr std::chrono::seconds kQuiet{2};  // a search that is over by then says nothing of its progress

Prior prior_of(const FixArguments& options) {
  Prior prior;
  if (options.radius_m > 0.0) prior.circle = GeoCircle{{options.lat, options.lon}, options.radius_m};
  prior.box = options.bbox;
  if (options.heading_deg) {
    prior.heading = HeadingRange{Angle::degrees(*options.heading_deg), Angle::degrees(options.heading_range_deg)};
  }
  return prior;
}

void print_mode(const FixMode& mode) {
  fmt::print("  {:.6f} {:.6f}  heading {:5.1f} +- {:.1f} deg  1 sigma {:.1f} x {:.1f} m  weight {:.3f}  rho {:.3f}\n",
             mode.pose.position.lat_deg, mode.pose.position.lon_deg, mode.pose.heading.compass_degrees(),
             mode.heading_sigma.degrees(), mode.sigma_m[0], mode.sigma_m[1], mode.weight, mode.rho);
}

void print_text(const Fix& fix) {
  fmt::print("{}", api::to_string(fix.status));
  if (fix.status == FixStatus::kFix) {
    fmt::print("  probability {:.4f}\n", fix.probability);
    print_mode(fix.modes.front());
  } else {
    fmt::print(" ({}): {}\n", fix.reason, fix.explanation);
    if (!fix.modes.empty()) fmt::print("best places, not to be flown on:\n");
    for (const FixMode& mode : fix.modes) print_mode(mode);
  }
  if (fix.scales > 1) {
    fmt::print("tried {} sizes of the ground; {:.3f} times that of the feature map fits best\n", fix.scales,
               fix.modes.empty() ? 1.0 : fix.modes.front().scale);
  }
  fmt::print("searched {:.2f} km2 at {} headings in {:.0f} ms\n", fix.searched_km2, fix.headings,
             fix.search_time.count());
  if (!fix.complete)
    fmt::print("the time limit ended the search: {:.1f} % of the poses were examined\n", 100.0 * fix.searched_share);
  if (!fix.proof) return;
  if (fix.proof->complete) {
    fmt::print("proof complete: no other pose of the region fits better (cells of {} m, {} headings)\n",
               fix.proof->cell_m, fix.proof->headings);
  } else {
    fmt::print("proof incomplete: {:.1f} % of the poses cannot fit better; the rest score at most {:.3f}\n",
               100.0 * fix.proof->excluded_share, fix.proof->bound);
  }
}

void run_fix(const FixArguments& options) {
  const MapView view = view_with_notes(options.map);
  const Prior prior = prior_of(options);
  search_region(view, prior, options.fix);  // before the frame, in which roads are looked for
  api::Features input = read_feature_input(options.input, view);
  FixOptions fix_options = options.fix;
  if (!options.calibration.empty()) fix_options.calibration = read_calibration(options.calibration);
  fix_options.own_frame = std::move(input.own_frame);
  fix_options.stop = stop_on_signals();
  Progress progress("searching", "headings");
  const auto began = std::chrono::steady_clock::now();
  fix_options.progress = [&](std::int64_t done, std::int64_t total) {
    if (std::chrono::steady_clock::now() - began >= kQuiet) progress.update(done, total);
  };
  const Fix fix = locate(view, input.map, prior, fix_options);
  if (options.as_json) {
    fmt::print("{}\n", json_text(api::to_json(fix, input), 2));
  } else {
    print_text(fix);
  }
}

}  // namespace

void add_fix_command(CLI::App& app) {
  auto* command = app.add_subcommand("fix", "Finds where a feature map or a frame was taken");
  command->footer(
      "Exit code: 0 for an answer, whichever (scripts read \"status\" of --json), 1 for none, 2 for wrong usage.\n"
      "Example: roadfix fix town.gpkg window.png --cell 2 --lat 57.70 --lon 11.97 --radius 800");
  const auto o = std::make_shared<FixArguments>();
  command->add_option("map", o->map, "Map file (GeoPackage)")->required();
  add_feature_input_options(*command, o->input);
  auto* lat = command->add_option("--lat", o->lat, "Prior: latitude of the centre, degrees");
  auto* lon = command->add_option("--lon", o->lon, "Prior: longitude of the centre, degrees");
  auto* radius = command->add_option("--radius,--radius-m", o->radius_m, "Prior: radius in metres");
  radius->check(positive())->needs(lat)->needs(lon);
  lat->needs(lon)->needs(radius);
  lon->needs(lat);
  add_bbox_option(*command, "Prior (together with --radius: what lies in both)", o->bbox);
  auto* heading = command->add_option("--heading", o->heading_deg, "Prior: true heading in degrees");
  command
      ->add_option("--heading-range", o->heading_range_deg,
                   "Prior: the heading lies within this many degrees of --heading")
      ->check(between(0.0, 180.0))
      ->needs(heading);
  heading->needs("--heading-range");
  command
      ->add_option("--confidence", o->fix.confidence,
                   "Minimum probability of a fix; the shipped calibration vouches for 0.9965 at most")
      ->capture_default_str()
      ->check(between(0.5, 0.999999));
  add_calibration_option(*command, o->calibration);
  command->add_option("--modes", o->fix.max_modes, "Maximum number of places to report")
      ->capture_default_str()
      ->check(CLI::Range(1, 64));
  command
      ->add_option(
          "--scale-range", o->fix.scale_range,
          "The ground may be smaller or larger by this share: roughly known altitude, or a lens that --exif knows "
          "from FocalLengthIn35mmFilm alone (0.1)")
      ->capture_default_str()
      ->check(between(0.0, kMaxScaleRange));
  command
      ->add_option(
          "--nadir-sigma", o->input.nadir_sigma_m,
          "How well the point below the UAV is known in the input, 1 sigma per axis in metres: the height times "
          "the error of roll and pitch (default with --agl: 1 degree where --roll and --pitch are given, else 5; "
          "otherwise 0)")
      ->check(not_negative(1000.0));
  command
      ->add_option("--nadir-heading-sigma", o->input.nadir_heading_sigma_deg,
                   "How far what the input shows may be turned about that point, 1 sigma in degrees (default with "
                   "--agl: 0.5, and what errors of roll and pitch do to the ground that a leaning camera sees; "
                   "otherwise 0)")
      ->check(not_negative(180.0));
  add_threads_option(*command, "--threads", o->fix.threads, "Threads of the search");
  add_seconds_option(*command, "--proof", o->fix.proof_time,
                     "Search this many seconds for a better place than the best candidate")
      ->check(positive());
  add_seconds_option(*command, "--time-limit", o->fix.time_limit,
                     "End the search after this many seconds and report what it has")
      ->check(positive());
  command->add_flag("--json", o->as_json, "The answer of the service as JSON");
  command->callback([o] { run_fix(*o); });
}

}  // namespace roadfix::cli
