#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "cli/fly/campaign.hpp"
#include "cli/fly/flight_files.hpp"
#include "cli/fly/flight_pictures.hpp"
#include "cli/fly/fly_ground.hpp"
#include "cli/fly/service_localizer.hpp"
#include "cli/given_options.hpp"
#include "cli/output_file.hpp"
#include "cli/terminal.hpp"
#include "core/geodesy/geo_box.hpp"
#include "core/units/error.hpp"
#include "core/units/json_text.hpp"

namespace roadfix::cli {
namespace {

using nlohmann::json;

json run_json(const fly::Run& run) {
  const auto found = fly::found_at(run.records);
  return {{"seed", run.seed},
          {"steps", run.records.size()},
          {"found_at_step", found ? json(run.records[*found].sequence) : json()},
          {"final_error_m", run.records.empty() ? json() : json(run.records.back().error_m)}};
}

json document(const FlyOptions& options, const MapView& map, const Ground& ground,
              const std::vector<fly::FilterRuns>& results, const fly::Events& events) {
  json filters = json::object();
  for (const auto& result : results) {
    json summary = to_json(fly::summary_of(result.runs, events));
    summary["flights"] = json::array();
    for (const fly::Run& run : result.runs) summary["flights"].push_back(run_json(run));
    filters[result.filter] = std::move(summary);
  }
  return {{"roadfix", ROADFIX_VERSION},
          {"options", options.given},
          {"map", options.map},
          {"map_version", map.id.version},
          {"ground", ground.what},
          {"seed", options.campaign.seed},
          {"particles", options.service.filter.particles},
          {"footprint_m", {ground.footprint.width_m, ground.footprint.height_m}},
          {"filters", filters}};
}

void write_files(const FlyOptions& options, const std::vector<fly::FilterRuns>& results, const UtmZone& zone) {
  if (!options.csv_file.empty()) {
    std::string text = fly::csv_header();
    for (const auto& result : results) {
      for (const fly::Run& run : result.runs) text += fly::csv_lines(result.filter, run, zone);
    }
    write_file(options.csv_file, text);
  }
  if (options.geojson_file.empty()) return;
  json features = json::array();
  for (const auto& result : results) {
    for (const fly::Run& run : result.runs) {
      for (auto& feature : fly::geojson_features(result.filter, run, zone)) features.push_back(std::move(feature));
    }
  }
  write_file(options.geojson_file, json_text({{"type", "FeatureCollection"}, {"features", features}}));
}

void require_known_once(const std::vector<std::string>& filters, int particles) {
  for (const std::string& filter : filters) {
    fly::filter_named(filter, particles);
    if (std::ranges::count(filters, filter) == 1) continue;
    throw InvalidInput("bad-parameter",
                       fmt::format("--filter names {} twice, which flies the same twice: name each once", filter));
  }
}

/// Vehicles see the ground of the file, and are looked for on the map of the service.
void note_other_map(const fly::ServicePlan& plan, const std::string& file, const std::string& version) {
  const auto served = fly::served_version(plan);
  if (!served || served == version) return;
  fmt::print(
      stderr,
      "note: {} is another map (version {}) than the service has as '{}' (version {}): what it finds, and what it "
      "does not, may be due to that\n",
      file, version, plan.map, *served);
}

fly::LocalizerFactory localizers_of(const FlyOptions& options, const MapView& map, const std::stop_token& stop) {
  fly::ServicePlan plan = options.service;
  plan.filter.vehicle = vehicle_of(options);
  if (plan.base.empty()) {
    require_known_once(options.campaign.filters, plan.filter.particles);
    return fly::library_localizers(map, plan.filter, stop);
  }
  if (options.campaign.filters != fly::Campaign().filters) {
    throw InvalidInput("option-without-effect", "a service has a filter of its own: leave out --filter or --server");
  }
  if (plan.map.empty()) plan.map = std::filesystem::path(options.map).stem().string();
  plan.stop = stop;
  note_other_map(plan, options.map, map.id.version);
  return fly::service_localizers(plan);
}

fly::Campaign campaign_of(const FlyOptions& options, const MapView& map, const Ground& ground,
                          const fly::FlightPlan& plan) {
  fly::Campaign campaign = options.campaign;
  if (options.vehicles > 0) campaign.jobs = options.vehicles;
  campaign.flights = flights_of(options, map, ground, plan);
  campaign.stop = stop_on_signals();
  campaign.localizer = localizers_of(options, map, campaign.stop);
  const double radius_m = campaign.start.radius_m.value_or(0.0);
  if (options.service.filter.start_is_known && radius_m > Reach::kMaxM) {
    throw InvalidInput("parameter-out-of-range",
                       fmt::format("--known-start: a --start-radius of {:g} m is too wide, at most {:g} are allowed",
                                   radius_m, Reach::kMaxM));
  }
  // The whole map is served: what lies around the square is not hidden from the track, but its start.
  const bool serves_more = !options.service.base.empty() && options.area_m > 0.0;
  if (serves_more) campaign.start.box = geo_box_around(map.zone, map.extent);
  return campaign;
}

void run_fly(const FlyOptions& options) {
  require_apart({options.json_file, options.csv_file, options.geojson_file, options.pictures.film},
                {options.map, options.over, options.course});
  require_writable({options.json_file, options.csv_file, options.geojson_file, options.pictures.film});
  require_folder(options.pictures.folder);
  const MapView map = map_of(options);
  const Ground ground = ground_of(options, map);
  const fly::FlightPlan plan = plan_of(options, map, ground);
  fly::Campaign campaign = campaign_of(options, map, ground, plan);
  fly::FlightPictures pictures(map, ground.imagery.get(), ground.footprint, options.pictures);
  campaign.watch = [&](const std::string& filter, const fly::Record& record, const fly::Localizer& localizer) {
    pictures.show(filter, record, localizer);
  };
  Progress progress("flying", "steps");
  campaign.progress = progress.updates();
  const auto results = fly::run(campaign, map.zone);
  const fly::Events events{plan.kidnapping, plan.outage};
  std::vector<std::pair<std::string, fly::Summary>> summaries;
  for (const auto& result : results) summaries.emplace_back(result.filter, fly::summary_of(result.runs, events));
  std::FILE* out = printed_beside({options.json_file, options.csv_file, options.geojson_file, options.pictures.film});
  fmt::print(out, "{}\nseed {}, {:.1f} x {:.1f} km of map\n{}", ground.what, options.campaign.seed,
             map.extent.width_m() / 1e3, map.extent.height_m() / 1e3, fly::to_table(summaries, events));
  write_files(options, results, map.zone);
  if (!options.json_file.empty()) {
    write_file(options.json_file, json_text(document(options, map, ground, results, events), 1) + '\n');
  }
  pictures.finish();
  if (!options.pictures.film.empty()) write_file(options.pictures.film, pictures.gif());
}

}  // namespace

void add_fly_command(CLI::App& app) {
  auto* command = app.add_subcommand("fly", "Flies simulated UAVs over imagery or a map and tracks them on the map");
  command->footer(
      "Columns of the table; medians over flights or steps, in brackets what 90 % (of the times 95 %) do not exceed:\n"
      "  found        flights whose best guess comes within 25 m of the truth and stays there for 10 steps; this and "
      "the\n"
      "               next two before the kidnapping, if there is one\n"
      "  updates      frames until it is found\n"
      "  error m      of all steps from then on\n"
      "  final m      error of the last step of every flight, found or not\n"
      "  wrong        flights that end with most of their weight on a wrong place\n"
      "  claims (at)  flights that ever claim a place (status converged), and after how many frames\n"
      "  false steps  steps that claim a place more than 25 m off, of all steps that claim one\n"
      "  NEES         squared error by the stated covariance, mean over the claims: 2 is consistent, more "
      "overconfident\n"
      "  in 95        share of the claims with the truth in their 95 % ellipse\n"
      "  ms/step      time of a step with a frame\n\n"
      "Examples: roadfix fly town.gpkg --over post.tif --filter paper,default --pictures figures\n"
      "          roadfix fly city.gpkg --over flight/frames.csv --filter paper,default --film flight.gif\n"
      "          roadfix fly city.gpkg --runs 100 --erase 0.3 --kidnap 50,2000 --json out.json\n"
      "          roadfix fly city.gpkg --server http://127.0.0.1:8080 --vehicles 16");
  const auto options = std::make_shared<FlyOptions>();
  add_fly_options(*command, *options);
  command->callback([options, command] {
    options->given = given_options(*command);
    run_fly(*options);
  });
}

}  // namespace roadfix::cli
