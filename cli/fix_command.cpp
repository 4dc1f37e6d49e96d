#include <fmt/format.h>

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/bbox_option.hpp"
#include "cli/calibration_option.hpp"
#include "cli/command.hpp"
#include "cli/feature_input.hpp"
#include "cli/fix_answers.hpp"
#include "cli/map_notes.hpp"
#include "cli/number_checks.hpp"
#include "cli/output_file.hpp"
#include "cli/picture_files.hpp"
#include "cli/terminal.hpp"
#include "cli/threads_option.hpp"
#include "cli/unit_options.hpp"
#include "core/geodesy/latlon.hpp"
#include "core/locate/levelled_fix.hpp"
#include "core/units/json_text.hpp"
#include "server/api/fix_json.hpp"
#include "server/api/fix_request.hpp"
#include "server/api/limits.hpp"
#include "server/api/position_answer.hpp"

namespace roadfix::cli {
namespace {

struct FixArguments {
  std::string map;
  std::vector<std::string> pictures;
  FeatureInputOptions input;
  LatLon centre;
  std::optional<double> radius_m;
  std::optional<GeoBox> bbox;
  std::optional<double> heading_deg;
  double heading_range_deg = 180.0;
  std::string calibration;
  std::optional<double> alt_m;
  std::optional<double> takeoff_alt_m;
  FixOptions fix;
  std::optional<std::chrono::milliseconds> time_limit;
  bool as_json = false;
  std::string csv;
};

constexpr std::chrono::seconds kUnsaved{10};  // of answers, at most, where the process is killed

Prior prior_of(const FixArguments& options) {
  Prior prior;
  if (options.radius_m) prior.circle = GeoCircle{options.centre, *options.radius_m};
  prior.box = options.bbox;
  if (options.heading_deg) {
    prior.heading = HeadingRange{Angle::degrees(*options.heading_deg), Angle::degrees(options.heading_range_deg)};
  }
  return prior;
}

/// `picture`: which of several it is.
void print_answer(const Fix& fix, const api::Features& input, bool as_json, const std::optional<std::string>& picture) {
  if (as_json) {
    nlohmann::json answer = api::to_json(fix, input);
    if (picture) answer["file"] = *picture;
    fmt::print("{}\n", json_text(answer, picture ? -1 : 2));
  } else {
    if (picture) fmt::print("{}: ", *picture);
    print_text(fix);
  }
}

/// What is the same for all pictures.
struct Search {
  MapView view;
  Prior prior;
  FixOptions options;
  std::optional<std::chrono::milliseconds> time_limit;
  FeatureInputOptions input;
  GridBox box;                          ///< of the region that is searched
  std::optional<Altitude> altitude;     ///< of frames, where all have the same
  std::optional<double> takeoff_alt_m;  ///< of photos, whose files tell the rest

  double agl_m(double above_sea_m) const { return required_agl_m(view, box, above_sea_m); }
};

Search search_of(const FixArguments& options, bool several) {
  constexpr std::size_t kSearchCacheBytes = std::size_t{512} << 20;  // all pictures search the same map
  const std::size_t cache_bytes = several ? kSearchCacheBytes : 0;
  Search search{view_with_notes(options.map, cache_bytes),
                prior_of(options),
                options.fix,
                options.time_limit,
                options.input,
                {},
                {},
                options.takeoff_alt_m};
  // Before the frame, in which roads are looked for.
  search.box = search_region(search.view, search.prior, options.fix).box;
  if (options.takeoff_alt_m) required_ground(search.view, search.box);
  double& agl_m = search.input.frame.camera.agl_m;
  if (options.alt_m) agl_m = search.agl_m(*options.alt_m);
  if (agl_m > 0.0) search.altitude = Altitude{options.alt_m, agl_m};
  if (!options.calibration.empty()) search.options.calibration = read_calibration(options.calibration);
  return search;
}

/// What a picture shows, and from where.
struct Seen {
  api::Features features;
  std::optional<Altitude> altitude;
};

Seen seen_in(const std::string& picture, const Search& search, FeatureInput& inputs) {
  if (!search.takeoff_alt_m) {
    api::Features features = inputs.read(picture);
    const auto altitude = search.altitude ? search.altitude : api::altitude_in_file(features);
    return {std::move(features), altitude};
  }
  const auto agl_of = [&](double above_sea_m) { return search.agl_m(above_sea_m); };
  const api::AboveTakeoff taken = above_takeoff(picture, *search.takeoff_alt_m, agl_of);
  return {inputs.read(picture, taken.takeoff_agl_m), taken.altitude};
}

Fix located(const Search& search, Seen& seen, OnProgress progress = {}) {
  FixOptions options = search.options;
  api::Features& input = seen.features;
  options.own_frame = std::move(input.own_frame);
  options.others = std::move(input.others);
  options.left_out = input.left_out;
  options.search.deadline = Deadline(stop_on_signals()).within(search.time_limit);
  options.search.progress = std::move(progress);
  return locate_levelled(seen.altitude, search.view, input.map, search.prior, options);
}

void fix_one(const FixArguments& options, const std::filesystem::path& picture) {
  const Search search = search_of(options, false);
  FeatureInput inputs(search.input, search.view);
  Seen seen = seen_in(picture, search, inputs);
  Progress progress("searching", "headings");
  const Fix fix = located(search, seen, progress.updates_if_long());
  print_answer(fix, seen.features, options.as_json, std::nullopt);
}

/// What was answered before the end came is in the table, whatever ended the command.
void fix_all(const FixArguments& options, const Pictures& pictures) {
  if (!options.input.also.empty()) throw CLI::ExcludesError("--also", "several pictures and --csv");
  for (const auto& file : pictures.files) require_apart({options.csv}, {file});
  require_writable({options.csv});
  const Search search = search_of(options, pictures.several);
  FeatureInput inputs(search.input, search.view);
  std::string table = fix_columns();
  auto saved = std::chrono::steady_clock::now();
  const auto save = [&] {
    if (!options.csv.empty()) write_file(options.csv, table);
    saved = std::chrono::steady_clock::now();
  };
  const bool grows = !options.csv.empty() && is_replaced(options.csv);
  std::size_t left_out = 0;
  try {
    left_out = for_each_picture(pictures, "locating", options.csv.empty(), [&](const std::filesystem::path& file) {
      Seen seen = seen_in(file, search, inputs);
      const Fix fix = located(search, seen);
      if (options.csv.empty()) {
        print_answer(fix, seen.features, options.as_json, file.string());
      } else {
        table += row_of(file, fix);
        if (grows && std::chrono::steady_clock::now() - saved >= kUnsaved) save();
      }
    });
  } catch (...) {
    save();
    throw;
  }
  save();
  require_none(left_out, pictures.files.size());
}

void run_fix(const FixArguments& options) {
  const Pictures pictures = pictures_of(options.pictures, kPictureEndings);
  pictures.several || !options.csv.empty() ? fix_all(options, pictures) : fix_one(options, pictures.files.front());
}

void add_prior_options(CLI::App& command, FixArguments& o) {
  auto* lat = command.add_option("--lat", o.centre.lat_deg, "Prior: latitude of the centre, degrees");
  auto* lon = command.add_option("--lon", o.centre.lon_deg, "Prior: longitude of the centre, degrees");
  auto* radius = command.add_option("--radius,--radius-m", o.radius_m, "Prior: radius in metres");
  radius->check(positive())->needs(lat)->needs(lon);
  lat->needs(lon)->needs(radius);
  lon->needs(lat);
  add_bbox_option(command, "Prior (together with --radius: what lies in both)", o.bbox);
  auto* heading = command.add_option("--heading", o.heading_deg, "Prior: true heading in degrees");
  command
      .add_option("--heading-range", o.heading_range_deg,
                  "Prior: the heading lies within this many degrees of --heading")
      ->check(between(0.0, 180.0))
      ->needs(heading);
  heading->needs("--heading-range");
}

void add_nadir_options(CLI::App& command, FixArguments& o) {
  command
      .add_option(
          "--nadir-sigma", o.input.nadir_sigma_m,
          "How well the point below the UAV is known in the input, 1 sigma per axis in metres: the height times "
          "the error of roll and pitch (default with --agl: that of --attitude-sigma, otherwise 0)")
      ->check(not_negative(1000.0));
  command
      .add_option("--nadir-heading-sigma", o.input.nadir_heading_sigma_deg,
                  "How far what the input shows may be turned about that point, 1 sigma in degrees (default with "
                  "--agl: 0.5, and what errors of roll and pitch do to the ground that a leaning camera sees; "
                  "otherwise 0)")
      ->check(not_negative(180.0));
}

}  // namespace

void add_fix_command(CLI::App& app) {
  auto* command = app.add_subcommand("fix", "Finds where feature maps or frames were taken");
  command->footer(
      "Exit code: 0 for an answer, whichever (scripts read \"status\" of --json), 1 for none, 2 for wrong usage. Of "
      "several pictures those that cannot be read are left out, which is said; the code is 1 then.\n"
      "Examples: roadfix fix town.gpkg window.png --cell 2 --lat 57.70 --lon 11.97 --radius 800\n"
      "          roadfix fix town.gpkg photos/ --exif --csv fixes.csv");
  const auto o = std::make_shared<FixArguments>();
  command->add_option("map", o->map, "Map file (GeoPackage)")->required();
  command
      ->add_option("input", o->pictures, std::string(kInputMeaning) + "; several of them, and folders of PNG and JPEG")
      ->required();
  add_feature_input_options(*command, o->input);
  command
      ->add_option(
          "--alt", o->alt_m,
          "Height above the sea in metres, in place of --agl with --fov, --focal-px or --exif, where the map knows how "
          "high its ground is (roadfix terrain)")
      ->check(between(api::kAltitude.min, api::kAltitude.max))
      ->excludes("--agl")
      ->excludes("--gsd")
      ->excludes("--cell");
  command
      ->add_option("--takeoff-alt", o->takeoff_alt_m,
                   "Height of the take-off's ground above the sea in metres, with --exif, whose height above the "
                   "take-off then gives that above the sea, where the map knows how high its ground is")
      ->check(between(api::kAltitude.min, api::kAltitude.max))
      ->needs("--exif")
      ->excludes("--agl")
      ->excludes("--alt");
  add_prior_options(*command, *o);
  command
      ->add_option("--confidence", o->fix.confidence,
                   "Minimum probability of a fix; the shipped calibration vouches for 0.9965 at most")
      ->capture_default_str()
      ->check(between(api::kConfidence.min, api::kConfidence.max));
  add_calibration_option(*command, o->calibration);
  command->add_option("--modes", o->fix.search.max_modes, "Maximum number of places to report")
      ->capture_default_str()
      ->check(CLI::Range(1, api::Limits().modes));
  command
      ->add_option(
          "--scale-range", o->fix.search.scale_range,
          "The ground may be smaller or larger by this share: roughly known altitude, or a lens that --exif knows "
          "from FocalLengthIn35mmFilm alone (0.1)")
      ->capture_default_str()
      ->check(between(0.0, kMaxScaleRange));
  add_nadir_options(*command, *o);
  add_threads_option(*command, "--threads", o->fix.search.threads, "Threads of the search");
  add_seconds_option(*command, "--proof", o->fix.search.proof_time,
                     "Search this many seconds for a better place than the best candidate")
      ->check(positive());
  add_seconds_option(*command, "--time-limit", o->time_limit,
                     "End the search after this many seconds and report what it has")
      ->check(positive());
  auto* json = command->add_flag(
      "--json", o->as_json, "The answer of the service as JSON; of several pictures one a line, with its \"file\"");
  command->add_option("--csv", o->csv, "Write a table with a row for each picture to this file")
      ->type_name("FILE")
      ->excludes(json);
  command->callback([o] { run_fix(*o); });
}

}  // namespace roadfix::cli
