#include "cli/command.hpp"
#include "cli/detector_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "cli/terminal.hpp"
#include "core/detect/make_detector.hpp"
#include "core/units/error.hpp"
#include "tiles/pipeline/ingest.hpp"
#include "tiles/pipeline/open_source.hpp"
#include "tiles/sources/road_rules.hpp"

namespace roadfix::cli {
namespace {

struct IngestArguments {
  std::vector<std::string> sources;
  std::string map;
  std::string name;
  std::string meaning = "auto";
  double cell_m = 2.0;
  std::string zone;
  std::string crs;
  std::string collar;
  std::string rules_file;
  std::string classes;
  std::string class_attribute;
  std::string width_attribute;
  double width_m = 0.0;
  VectorOptions vectors;
  DetectorChoice detector;
  double registration_sigma_m = 0.0;
  SourceRecord record;  ///< date, licence and attribution
  IngestOptions options;
  bool dry_run = false;
  bool json = false;
};

RoadRules rules_of(const IngestArguments& arguments) {
  RoadRules rules;
  if (!arguments.rules_file.empty()) {
    std::ifstream file(arguments.rules_file);
    if (!file) throw NotFound("rules-not-found", fmt::format("{}: cannot be read", arguments.rules_file));
    rules = RoadRules::parse(std::string(std::istreambuf_iterator<char>(file), {}));
  }
  if (!arguments.classes.empty()) rules.select(arguments.classes);
  if (!arguments.class_attribute.empty()) rules.set_class_attribute(arguments.class_attribute);
  if (!arguments.width_attribute.empty()) rules.set_width_attribute(arguments.width_attribute);
  if (arguments.width_m > 0.0) rules.set_width_m(arguments.width_m);
  return rules;
}

SourceRequest request_of(const IngestArguments& arguments, const std::string& source) {
  SourceRequest request;
  request.files = find_source(source, parse_meaning(arguments.meaning));
  if (!arguments.name.empty()) request.files.name = arguments.name;
  request.raster.crs = arguments.crs;
  if (!arguments.collar.empty()) request.raster.collar = parse_colour(arguments.collar);
  request.vectors = arguments.vectors;
  request.vectors.crs = arguments.crs;
  request.rules = rules_of(arguments);
  return request;
}

UtmZone zone_of(const IngestArguments& arguments, const SourceRequest& first) {
  if (arguments.zone.empty()) return UtmZone::containing(centre_of_source(first));
  std::string digits = arguments.zone;
  if (digits.starts_with("EPSG:")) digits.erase(0, 5);
  const bool number =
      !digits.empty() && digits.size() <= 5 && std::ranges::all_of(digits, [](char c) { return c >= '0' && c <= '9'; });
  const std::optional<UtmZone> zone = number ? UtmZone::from_epsg(std::stoi(digits)) : std::nullopt;
  if (!zone) {
    throw InvalidInput("zone-unknown",
                       fmt::format("--zone {}: write the EPSG code of a UTM zone on WGS 84, EPSG:32601 to "
                                   "32660 in the north, 32701 to 32760 in the south",
                                   arguments.zone));
  }
  return *zone;
}

/// Those of the map, if it is there: then --cell and --zone must not contradict.
MapSettings settings_of(const IngestArguments& arguments, const SourceRequest& first, bool cell_given) {
  std::optional<MapSettings> existing = MapWriter::settings_of(arguments.map);
  if (!existing) return {zone_of(arguments, first), arguments.cell_m};
  if (cell_given) existing->cell_m = arguments.cell_m;
  if (!arguments.zone.empty()) existing->zone = zone_of(arguments, first);
  return *existing;
}

SourceRecord record_of(const IngestArguments& arguments, const SourceRequest& request, const SourceSummary& summary) {
  SourceRecord record = arguments.record;
  record.name = request.files.name;
  record.kind = summary.kind;
  record.location = request.files.location;
  record.fingerprint = fmt::format("{}-seed{}", summary.fingerprint, arguments.options.seed);
  record.method = summary.method;
  record.registration_sigma_m =
      arguments.registration_sigma_m > 0.0 ? arguments.registration_sigma_m : summary.registration_sigma_m;
  return record;
}

nlohmann::json summary_json(const SourceRecord& record, const SourceSummary& summary, std::int64_t blocks,
                            const MapSettings& settings) {
  const double side_km = kTileCells * settings.cell_m / 1e3;
  nlohmann::json json{{"source", record.name},
                      {"kind", record.kind},
                      {"files_crs", summary.crs},
                      {"map_crs", fmt::format("EPSG:{}", settings.zone.epsg())},
                      {"cell_m", settings.cell_m},
                      {"blocks", blocks},
                      {"blocks_km2", static_cast<double>(blocks) * side_km * side_km},
                      {"method", record.method}};
  if (summary.native_gsd_m > 0.0) {
    json["native_gsd_m"] = summary.native_gsd_m;
    json["chosen_gsd_m"] = summary.chosen_gsd_m;
  } else {
    json["features"] = summary.features;
    json["left_out"] = summary.left_out;
  }
  if (!summary.notes.empty()) json["notes"] = summary.notes;
  return json;
}

/// What a dry run prints: nothing is read but headers (all features, of vectors), nothing is written.
void print_plan(nlohmann::json json, bool as_json) {
  constexpr double kBytesPerBlock = 30'000.0;  // evidence and fused tile with overviews, of a city
  json["expected_bytes"] = static_cast<std::int64_t>(kBytesPerBlock * json["blocks"].get<double>());
  if (as_json) {
    fmt::print("{}\n", json.dump());
    return;
  }
  for (const auto& [key, value] : json.items()) {
    fmt::print("{:14} {}\n", key, value.is_string() ? value.get<std::string>() : value.dump());
  }
}

/// Rates count the source's own pixels, of its observed ground.
void print_report(nlohmann::json json, const IngestReport& report, double cell_mp, bool as_json) {
  const double fresh = static_cast<double>(report.blocks - report.blocks_before);
  json["blocks_done_before"] = report.blocks_before;
  json["observed_cells"] = report.observed_cells;
  json["reading_s"] = report.reading_s;
  json["fusing_s"] = report.fusing_s;
  const double share = fresh / static_cast<double>(std::max<std::int64_t>(1, report.blocks));
  const bool lines = json.contains("features");
  const double amount =
      lines ? share * json["features"].get<double>() : static_cast<double>(report.observed_cells) * cell_mp;
  const double rate = report.reading_s > 0.0 ? amount / report.reading_s : 0.0;
  json[lines ? "features_per_s" : "megapixels_per_s"] = rate;
  if (as_json) {
    fmt::print("{}\n", json.dump());
    return;
  }
  fmt::print("{}: {} blocks ({} done before), {:.1f} s reading and detecting ({:.2f} {}/s), {:.1f} s fusing\n",
             json["source"].get<std::string>(), report.blocks, report.blocks_before, report.reading_s, rate,
             lines ? "features" : "MP", report.fusing_s);
}

/// On stderr, so that --json stays clean.
void print_notes(const SourceFiles& files, const SourceSummary& summary) {
  for (const std::string& note : summary.notes) fmt::print(stderr, "note: {}\n", note);
  if (files.left_out.empty()) return;
  fmt::print(stderr,
             "note: a folder is one source, {} one of images; left out are {}: ingest vectors by their own paths\n",
             files.location, fmt::join(files.left_out, ", "));
}

void ingest_one(const IngestArguments& arguments, const SourceRequest& request, const MapSettings& settings,
                const RoadDetector* detector, std::optional<MapWriter>& writer, const std::stop_token& stop) {
  const std::unique_ptr<CellSource> source = open_source(request, settings, detector);
  const SourceSummary summary = source->summary();
  print_notes(request.files, summary);
  const SourceRecord record = record_of(arguments, request, summary);
  const auto blocks = static_cast<std::int64_t>(plan_blocks(*source, settings).size());
  const nlohmann::json json = summary_json(record, summary, blocks, settings);
  if (arguments.dry_run) {
    print_plan(json, arguments.json);
    return;
  }
  if (!writer) writer.emplace(arguments.map, settings);
  const double cell_px = settings.cell_m / summary.native_gsd_m;
  const double cell_mp = cell_px * cell_px / 1e6;
  IngestReport report;
  {
    const bool lines = summary.native_gsd_m == 0.0;
    const double lines_per_block =
        static_cast<double>(summary.features) / static_cast<double>(std::max<std::int64_t>(1, blocks));
    Progress reading(record.name, lines ? "features" : "MP",
                     lines ? lines_per_block : kTileCells * kTileCells * cell_mp);
    Progress fusing("fusing", "tiles");
    const IngestProgress progress{[&](std::int64_t done, std::int64_t total) { reading.update(done, total); },
                                  [&](std::int64_t done, std::int64_t total) { fusing.update(done, total); }};
    report = ingest(*source, record, settings, *writer, arguments.options, progress, stop);
  }
  print_report(json, report, cell_mp, arguments.json);
}

void run(const IngestArguments& arguments, bool cell_given) {
  const std::stop_token stop = stop_on_signals();
  if (!is_map_cell_size(arguments.cell_m)) {
    throw InvalidInput("cell-size-unknown", fmt::format("--cell {}: cells are a power of two of metres from {} to {}",
                                                        arguments.cell_m, kMinCellM, kMaxCellM));
  }
  std::vector<SourceRequest> requests;
  for (const std::string& source : arguments.sources) requests.push_back(request_of(arguments, source));
  for (std::size_t i = 0; i < requests.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (requests[i].files.name != requests[j].files.name) continue;
      throw InvalidInput("source-name-taken",
                         fmt::format("{} and {} would both be the source '{}': ingest them one by one with --name",
                                     requests[j].files.location, requests[i].files.location, requests[i].files.name));
    }
  }
  const bool imagery =
      std::ranges::any_of(requests, [](const auto& r) { return r.files.kind == SourceKind::kImagery; });
  const std::unique_ptr<RoadDetector> detector = imagery ? make_detector(arguments.detector) : nullptr;
  const MapSettings settings = settings_of(arguments, requests.front(), cell_given);
  std::optional<MapWriter> writer;
  for (const SourceRequest& request : requests) {
    ingest_one(arguments, request, settings, detector.get(), writer, stop);
  }
}

void add_content_options(CLI::App& command, IngestArguments& a) {
  command.add_option("--as", a.meaning,
                     "What the sources are: auto (vectors are roads, rasters imagery), imagery, roads");
  command.add_option("--name", a.name, "Name of the source in the map; default: stem of the file, name of the folder");
  command.add_option("--crs", a.crs, "Reference system of the sources where the files do not say it, or say it wrong");
  command.add_option("--nodata-color", a.collar, "Colour of the collar around the imagery: white, black or R,G,B");
  command.add_option("--layer", a.vectors.layer, "Only this layer of vector files");
  command.add_option("--extent", a.vectors.extent,
                     "Ground that road lines cover: W,S,E,N in degrees or a polygon file");
  command.add_option("--classes", a.classes, "Draw exactly these road classes, comma-separated");
  command.add_option("--rules", a.rules_file, "Table of road classes: lines 'class width_m yes|no'");
  command.add_option("--class-attribute", a.class_attribute, "Attribute that holds the road class; default: highway");
  command.add_option("--width-attribute", a.width_attribute, "Attribute that holds the width in metres");
  command.add_option("--width", a.width_m, "Width of all roads in metres")->check(CLI::Range(0.5, 100.0));
}

void add_provenance_options(CLI::App& command, IngestArguments& a) {
  command.add_option("--date", a.record.date, "Date of the content, ISO 8601");
  command.add_option("--licence", a.record.licence, "Licence of the content");
  command.add_option("--attribution", a.record.attribution, "Whom to name");
  command.add_option("--registration-sigma", a.registration_sigma_m,
                     "Uncertainty of the position, 1 sigma in metres; default: 2 for imagery, 3 rasters, 4 vectors");
}

}  // namespace

void add_ingest_command(CLI::App& app) {
  auto a = std::make_shared<IngestArguments>();
  CLI::App* command = app.add_subcommand(
      "ingest",
      "Builds or extends a road map from imagery (anything GDAL reads) and road data (anything OGR reads).\n"
      "Example: roadfix ingest city.tif roads.geojson --map city.gpkg\n"
      "Interrupted or killed, the same command goes on where it was.");
  command->add_option("SOURCE", a->sources, "Files, or folders of images or vector files (one source each)")
      ->required();
  command->add_option("--map", a->map, "The map file to create or extend")->required();
  CLI::Option* cell =
      command->add_option("--cell", a->cell_m, "Cell size of a new map in metres, a power of two; default: 2");
  command->add_option("--zone", a->zone,
                      "UTM zone of a new map, EPSG:326zz or 327zz; default: that of the first source");
  add_content_options(*command, *a);
  add_detector_options(*command, a->detector);
  add_provenance_options(*command, *a);
  a->options.jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  command->add_option("--jobs", a->options.jobs, "Blocks in work at a time; default: number of processors")
      ->check(CLI::Range(1, 1024));
  command->add_option("--seed", a->options.seed, "Seed of the detector's random numbers; default: 1");
  command->add_flag("--replace", a->options.replace, "Replace a source of the same name");
  command->add_flag("--dry-run", a->dry_run, "Print the plan and stop");
  command->add_flag("--json", a->json, "Print one line of JSON for each source");
  command->callback([a, cell] {
    if (!a->name.empty() && a->sources.size() > 1) throw CLI::ValidationError("--name", "names a single SOURCE");
    run(*a, cell->count() > 0);
  });
}

}  // namespace roadfix::cli
