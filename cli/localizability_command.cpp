#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/calibration_option.hpp"
#include "cli/command.hpp"
#include "cli/map_notes.hpp"
#include "cli/number_checks.hpp"
#include "cli/terminal.hpp"
#include "cli/threads_option.hpp"
#include "core/locate/map_survey.hpp"
#include "core/units/json_text.hpp"
#include "server/api/json_parts.hpp"

namespace roadfix::cli {
namespace {

struct LocalizabilityArguments {
  std::string map;
  std::string calibration;
  SurveyOptions survey;
  bool as_json = false;
};

double share(const MapSurvey& survey, std::int64_t places) {
  return survey.places() > 0 ? static_cast<double>(places) / static_cast<double>(survey.places()) : 0.0;
}

void print_json(const MapView& map, const SurveyOptions& options, const MapSurvey& found) {
  const nlohmann::json answer{{"map", api::to_json(map.id)},
                              {"made_by", api::made_by()},
                              {"footprint_m", options.query.footprint_m},
                              {"places", found.places()},
                              {"ground_km2", found.ground_m2 / 1e6},
                              {"distinct", share(found, found.distinct)},
                              {"sparse", share(found, found.sparse)},
                              {"bare", share(found, found.bare)}};
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
  const auto line = [&](const char* word, std::int64_t places, const char* meaning) {
    const double part = share(found, places);
    fmt::print("  {:<9} {:3.0f} %  {:6.1f} km2  {}\n", word, 100.0 * part, part * ground_km2, meaning);
  };
  line("distinct", found.distinct, "a frame gives a fix");
  line("sparse", found.sparse,
       "its roads fit elsewhere, too, or are too few to be sure: no fix, but a track may go on");
  line("bare", found.bare, "it shows hardly any road: no fix, and a track has odometry alone");
}

void run_localizability(const LocalizabilityArguments& arguments) {
  constexpr std::size_t kSearchCacheBytes = std::size_t{512} << 20;  // places search the ground of their neighbours
  const MapView view = view_with_notes(arguments.map, kSearchCacheBytes);
  SurveyOptions options = arguments.survey;
  if (!arguments.calibration.empty()) options.query.fix.calibration = read_calibration(arguments.calibration);
  options.query.fix.search.deadline = Deadline(stop_on_signals());
  MapSurvey found;
  {
    Progress progress("searching", "places");
    options.progress = progress.updates();
    found = survey(view, options);
  }
  arguments.as_json ? print_json(view, options, found) : print_text(view, options, found);
}

}  // namespace

void add_localizability_command(CLI::App& app) {
  auto* command = app.add_subcommand("localizability", "Says over how much of a map's ground a frame gives a fix");
  command->footer(
      "From the map alone: an upper bound of what frames give after a disaster. The service shows where that ground "
      "is, on its page.\n"
      "Example: roadfix localizability town.gpkg --footprint-m 400");
  const auto a = std::make_shared<LocalizabilityArguments>();
  command->add_option("map", a->map, "Map file (GeoPackage)")->required();
  command
      ->add_option("--footprint,--footprint-m", a->survey.query.footprint_m,
                   "Side of the square of ground that a frame shows, in metres")
      ->required()
      ->check(between(kSmallestFootprintM, kLargestFootprintM));
  command
      ->add_option("--places", a->survey.max_places,
                   "Ask at so many places at most, evenly spread: each takes about a second of one core")
      ->capture_default_str()
      ->check(CLI::Range(1, 1'000'000));
  add_calibration_option(*command, a->calibration);
  add_threads_option(*command, "--threads", a->survey.threads, "Places asked at a time");
  command->add_flag("--json", a->as_json, "Answer in JSON");
  command->callback([a] { run_localizability(*a); });
}

}  // namespace roadfix::cli
