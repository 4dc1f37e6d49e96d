#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "cli/command.hpp"
#include "cli/ingest/ingest_notes.hpp"
#include "cli/ingest/ingest_options.hpp"
#include "cli/ingest/ingest_report.hpp"
#include "cli/ingest/ingest_zone.hpp"
#include "cli/map_notes.hpp"
#include "cli/output_file.hpp"
#include "cli/terminal.hpp"
#include "core/detect/make_detector.hpp"
#include "core/units/error.hpp"
#include "tiles/pipeline/describe_source.hpp"
#include "tiles/pipeline/ingest.hpp"
#include "tiles/sources/temporary_files.hpp"
#include "tiles/store/map_reader.hpp"

namespace roadfix::cli {
namespace {

IngestReport ingest_with_progress(const PlannedSource& planned, const SourceSummary& summary,
                                  const SourceRecord& record, MapWriter& writer, IngestOptions options) {
  const bool lines = summary.is_lines();
  const double lines_per_block =
      static_cast<double>(summary.features) / static_cast<double>(std::max<std::int64_t>(1, planned.blocks));
  Progress reading(record.name, lines ? "features" : "MP",
                   lines ? lines_per_block : kTileCells * kTileCells * cell_mp(summary, writer.settings()));
  Progress fusing("fusing", "tiles");
  Progress comparing("comparing", "sources");
  options.on_blocks = reading.updates();
  options.on_fusing = fusing.updates();
  options.on_shifts = comparing.updates();
  return ingest(*planned.cells, record, writer, options);
}

/// The road data of a country take minutes to read.
PlannedSource plan_with_progress(SourceRequest request, const MapSettings& settings, const RoadDetector* detector) {
  Progress reading(fmt::format("reading {}", request.files.name), "%", 0.1);
  request.vectors.on_reading = reading.updates_if_long();
  return plan_source(request, settings, detector);
}

MapSettings settings_with_progress(const IngestArguments& arguments, SourceRequest first,
                                   const RoadDetector* detector) {
  Progress placing(fmt::format("placing {}", first.files.name), "%", 0.1);
  first.vectors.on_reading = placing.updates_if_long();
  return settings_of(arguments, first, detector);
}

void ingest_one(const IngestArguments& arguments, const SourceRequest& request, const MapSettings& settings,
                const RoadDetector* detector, std::optional<MapWriter>& writer, const std::stop_token& stop) {
  const PlannedSource planned = plan_with_progress(request, settings, detector);
  const CellSource& source = *planned.cells;
  SourceSummary summary = summary_of(source, request.files);
  std::ranges::move(zone_notes(source, settings), std::back_inserter(summary.notes));
  const std::optional<MapInfo> before = info_of(arguments.map);
  if (auto note = note_on_distance(source, before)) summary.notes.push_back(std::move(*note));
  SourceRecord record = record_of(request.files, summary, arguments.options.seed);
  const auto records = before ? records_of(*before, record.name) : std::vector<SourceRecord>();
  std::ranges::move(describe_source(record, summary.told, arguments.told, records, arguments.options.replace),
                    std::back_inserter(summary.notes));
  if (arguments.options.replace) {
    if (auto note = note_on_nothing_replaced(before, record.name)) summary.notes.push_back(std::move(*note));
    if (auto note = note_on_ground_lost(source, arguments.map, record.name, settings.cell_m))
      summary.notes.push_back(std::move(*note));
  }
  print_notes(request.files, summary.notes);
  const nlohmann::json json = summary_json(record, summary, planned.blocks, settings);
  if (arguments.dry_run) {
    MapWriter::require_acceptable(arguments.map, settings, record, arguments.options.replace);
    const std::int64_t held = std::ssize(finished_blocks(arguments.map, record));
    print_plan(json, planned.blocks - held, arguments.map, arguments.json);
    return;
  }
  if (!writer) writer.emplace(arguments.map, settings);
  IngestOptions options = arguments.options;
  options.stop = stop;
  const IngestReport report = ingest_with_progress(planned, summary, record, *writer, std::move(options));
  if (report.observed_cells == 0 && report.blocks_before == 0) {
    fmt::print(stderr, "note: nothing of {} was observed: {}\n", request.files.location,
               why_nothing_observed(source, settings.cell_m));
  }
  if (report.blocks_before < report.blocks) {
    note_copies(writer->twins_of(record.name), record.name, arguments.map, report.shifts);
  }
  note_shifts(record.name, report.shifts);
  print_report(json, summary, settings, report, arguments.json);
}

/// A map that is its own source would count all that it knows twice. That it lies in the folder of its sources is fine.
void refuse_the_map_itself(SourceFiles& files, const std::string& map) {
  const auto is_map = [&](const std::string& path) {
    std::error_code none;  // where the map does not exist yet
    return std::filesystem::equivalent(path, map, none);
  };
  std::erase_if(files.left_out, is_map);
  for (const std::string& path : files.paths) {
    if (!is_map(path)) continue;
    throw InvalidInput("source-is-target",
                       fmt::format("{} is the map itself: name another SOURCE, or another --map", path));
  }
}

void run(const IngestArguments& arguments) {
  const std::stop_token stop = stop_on_signals();
  require_name(arguments.map);
  keep_temporary_files_beside(arguments.map);
  std::vector<SourceRequest> requests;
  for (const std::string& source : arguments.sources) {
    requests.push_back(request_of(arguments, source));
    requests.back().vectors.stop = stop;
  }
  refuse_without_effect(arguments, requests);
  for (std::size_t i = 0; i < requests.size(); ++i) {
    refuse_the_map_itself(requests[i].files, arguments.map);
    for (std::size_t j = 0; j < i; ++j) {
      if (requests[i].files.name != requests[j].files.name) continue;
      throw InvalidInput("source-name-taken",
                         fmt::format("{} and {} would both be the source '{}': ingest them one by one with --name",
                                     requests[j].files.location, requests[i].files.location, requests[i].files.name));
    }
  }
  const bool imagery =
      std::ranges::any_of(requests, [](const auto& r) { return r.files.kind == SourceKind::kImagery; });
  if (imagery) note_missing_network(arguments.detector);
  const std::unique_ptr<RoadDetector> detector = imagery ? make_map_detector(arguments.detector) : nullptr;
  const MapSettings settings = settings_with_progress(arguments, requests.front(), detector.get());
  std::optional<MapWriter> writer;
  try {
    for (const SourceRequest& request : requests) {
      ingest_one(arguments, request, settings, detector.get(), writer, stop);
    }
  } catch (...) {
    if (writer) writer->remove_if_new_and_empty();
    throw;
  }
}

}  // namespace

void add_ingest_command(CLI::App& app) {
  auto a = std::make_shared<IngestArguments>();
  CLI::App* command = app.add_subcommand(
      "ingest",
      "Builds or extends a road map from imagery (anything GDAL reads) and road data (anything OGR reads).\n"
      "Example: roadfix ingest city.tif roads.geojson --map city.gpkg\n"
      "To resume after an interruption, run the same command again.");
  add_ingest_options(*command, *a);
  command->callback([a] {
    if (!a->name.empty() && a->sources.size() > 1) throw CLI::ValidationError("--name", "names a single SOURCE");
    run(*a);
  });
}

}  // namespace roadfix::cli
