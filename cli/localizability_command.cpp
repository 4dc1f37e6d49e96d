#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "cli/calibration_option.hpp"
#include "cli/command.hpp"
#include "cli/map_notes.hpp"
#include "cli/number_checks.hpp"
#include "cli/output_file.hpp"
#include "cli/place_kinds.hpp"
#include "cli/route_input.hpp"
#include "cli/route_report.hpp"
#include "cli/terminal.hpp"
#include "cli/threads_option.hpp"
#include "cli/unit_options.hpp"
#include "core/survey/map_survey.hpp"
#include "core/units/json_text.hpp"
#include "server/api/json_parts.hpp"
#include "server/api/route_json.hpp"

namespace roadfix::cli {
namespace {

struct LocalizabilityArguments {
  std::string map;
  std::string calibration;
  SurveyOptions survey;
  std::string route;
  std::optional<double> footprint_m;
  std::optional<Angle> fov;                 ///< in place of it, along a route
  double aspect = DownwardCamera{}.aspect;  ///< with that
  std::optional<double> usual_agl_m;
  std::optional<double> every_m;  ///< default: half a footprint
  std::string geojson_file;
  bool as_json = false;
};

double share(const MapSurvey& survey, std::int64_t places) {
  return survey.places() > 0 ? static_cast<double>(places) / static_cast<double>(survey.places()) : 0.0;
}

nlohmann::json asked_json(const MapView& map) { return {{"map", api::to_json(map.id)}, {"made_by", api::made_by()}}; }

void print_json(const MapView& map, const SurveyOptions& options, const MapSurvey& found) {
  nlohmann::json answer = asked_json(map);
  answer.update({{"footprint_m", options.query.footprint_m},
                 {"places", found.places()},
                 {"ground_km2", found.ground_m2 / 1e6},
                 {"distinct", share(found, found.distinct)},
                 {"sparse", share(found, found.sparse)},
                 {"bare", share(found, found.bare)}});
  fmt::print("{}\n", json_text(answer, 2));
}

void print_text(const MapView& map, const SurveyOptions& options, const MapSurvey& found) {
  constexpr std::int64_t kFewPlaces = 20;
  if (found.places() == 0) {
    fmt::print("{}: nowhere is half of a footprint of {:g} m observed\n", map.id.name, options.query.footprint_m);
    return;
  }
  const double ground_km2 = found.ground_m2 / 1e6;
  fmt::print("{}: {:.1f} km2 of ground, for frames that show {:g} m of it; asked at places: {}{}\n", map.id.name,
             ground_km2, options.query.footprint_m, found.places(),
             found.places() < kFewPlaces ? ", too few for more than a rough idea" : "");
  const auto print_line = [&](PlaceKind kind, std::int64_t places) {
    fmt::print("{}", kind_line(kind, share(found, places), ground_km2, "km2"));
  };
  print_line(PlaceKind::kDistinct, found.distinct);
  print_line(PlaceKind::kSparse, found.sparse);
  print_line(PlaceKind::kBare, found.bare);
}

void survey_map(const LocalizabilityArguments& arguments, const MapView& map, SurveyOptions options) {
  MapSurvey found;
  {
    Progress progress("searching", "places");
    options.progress = progress.updates();
    found = survey(map, options);
  }
  arguments.as_json ? print_json(map, options, found) : print_text(map, options, found);
}

RouteSurvey surveyed_route(const LocalizabilityArguments& arguments, const routes::Route& route, const MapView& map,
                           const SurveyOptions& options) {
  std::optional<DownwardCamera> camera;
  if (arguments.fov) camera = DownwardCamera{*arguments.fov, arguments.aspect};
  Progress progress("searching", "places");
  return survey_route(map, route,
                      {.query = options.query,
                       .camera = camera,
                       .usual_agl_m = arguments.usual_agl_m,
                       .every_m = arguments.every_m,
                       .max_places = options.max_places,
                       .threads = options.threads,
                       .progress = progress.updates()});
}

void survey_along_route(const LocalizabilityArguments& arguments, const MapView& map, const SurveyOptions& options) {
  require_apart({arguments.geojson_file}, {arguments.map, arguments.route});
  require_writable({arguments.geojson_file});
  const routes::Route route = route_with_notes(arguments.route);
  const RouteSurvey found = surveyed_route(arguments, route, map, options);
  std::FILE* out = printed_beside({arguments.geojson_file});
  if (arguments.as_json) {
    nlohmann::json answer = asked_json(map);
    if (arguments.footprint_m) answer["footprint_m"] = *arguments.footprint_m;
    if (arguments.fov) answer.update({{"fov_deg", arguments.fov->degrees()}, {"aspect", arguments.aspect}});
    answer.update(api::summary_json(found));
    answer["left_out"] = route.left_out;
    fmt::print(out, "{}\n", json_text(answer, 2));
  } else {
    fmt::print(out, "{}", route_text(found, arguments.route, arguments.footprint_m));
  }
  if (!arguments.geojson_file.empty()) write_file(arguments.geojson_file, json_text(api::geojson_of(found)));
}

void run_localizability(const LocalizabilityArguments& arguments) {
  if (!arguments.footprint_m && !arguments.fov) {
    throw CLI::RequiredError("--footprint-m or, with --route, --fov");
  }
  constexpr std::size_t kSearchCacheBytes = std::size_t{512} << 20;  // places search the ground of their neighbours
  const MapView view = view_with_notes(arguments.map, kSearchCacheBytes);
  SurveyOptions options = arguments.survey;
  options.query.footprint_m = arguments.footprint_m.value_or(options.query.footprint_m);
  if (!arguments.calibration.empty()) options.query.fix.calibration = read_calibration(arguments.calibration);
  options.query.fix.search.deadline = Deadline(stop_on_signals());
  arguments.route.empty() ? survey_map(arguments, view, options) : survey_along_route(arguments, view, options);
}

}  // namespace

void add_localizability_command(CLI::App& app) {
  auto* command =
      app.add_subcommand("localizability", "Says over how much of a map's ground, or of a route, a frame gives a fix");
  command->footer(
      "From the map alone: an upper bound of what frames give after a disaster. The service shows where that ground "
      "is, on its page.\n"
      "Examples: roadfix localizability town.gpkg --footprint-m 400\n"
      "          roadfix localizability town.gpkg --footprint-m 400 --route mission.plan --geojson route.geojson\n"
      "          roadfix localizability town.gpkg --fov 73 --route mission.plan");
  const auto a = std::make_shared<LocalizabilityArguments>();
  command->add_option("map", a->map, "Map file (GeoPackage)")->required();
  CLI::Option* footprint = command
                               ->add_option("--footprint,--footprint-m", a->footprint_m,
                                            "Side of the square of ground that a frame shows, in metres")
                               ->check(between(kSmallestFootprintM, kLargestFootprintM));
  command
      ->add_option("--places", a->survey.max_places,
                   "Ask at so many places at most, evenly spread: each takes about a second of one core")
      ->capture_default_str()
      ->check(CLI::Range(1, 1'000'000));
  CLI::Option* route = command->add_option(
      "--route", a->route,
      "Ask along this route only: a plan of QGroundControl, a list of waypoints (QGC WPL), or GeoJSON with a line or "
      "points");
  CLI::Option* fov =
      add_degrees_option(*command, "--fov", a->fov,
                         "Of a camera that looks straight down: field of view across, degrees. In place of "
                         "--footprint-m: frames show as much ground as from the heights that the route tells. Those "
                         "above the sea take a map that knows the heights of its ground (roadfix terrain)")
          ->needs(route)
          ->excludes(footprint)
          ->check(positive(179.0));
  command
      ->add_option("--aspect", a->aspect,
                   "Width of its frames over their height; the footprint is the square that is as large. Default: 4/3")
      ->needs(fov)
      ->check(between(0.1, 10.0));
  command
      ->add_option("--agl", a->usual_agl_m,
                   "Height above ground in metres at places of which the route tells no height")
      ->needs(fov)
      ->check(positive());
  command
      ->add_option("--every-m", a->every_m,
                   "Metres of the route for each place; default: half a footprint, with --fov of the mean one")
      ->needs(route)
      ->check(positive());
  command->add_option("--geojson", a->geojson_file, "Write the route, piece by piece, with what was found")
      ->needs(route);
  add_calibration_option(*command, a->calibration);
  add_threads_option(*command, "--threads", a->survey.threads, "Places asked at a time");
  command->add_flag("--json", a->as_json, "Answer in JSON");
  command->callback([a] { run_localizability(*a); });
}

}  // namespace roadfix::cli
