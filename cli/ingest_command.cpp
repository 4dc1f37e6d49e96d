#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "cli/command.hpp"
#include "cli/ingest_options.hpp"
#include "cli/ingest_report.hpp"
#include "cli/ingest_zone.hpp"
#include "cli/map_notes.hpp"
#include "cli/output_file.hpp"
#include "cli/terminal.hpp"
#include "core/detect/make_detector.hpp"
#include "core/units/error.hpp"
#include "core/units/shell_word.hpp"
#include "tiles/pipeline/describe_source.hpp"
#include "tiles/pipeline/ingest.hpp"
#include "tiles/sources/temporary_files.hpp"
#include "tiles/store/map_reader.hpp"

namespace roadfix::cli {
namespace {

/// What was made of another source tells nothing that this one does not.
void note_copies(MapWriter& writer, const std::string& source, const std::string& map, const ShiftReport& shifts) {
  const std::vector<std::string> twins = writer.twins_of(source);
  std::set<std::string> copies(twins.begin(), twins.end());
  if (const auto found = shifts.copies.find(source); found != shifts.copies.end()) {
    copies.insert(found->second.begin(), found->second.end());
  }
  for (const std::string& copy : copies) {
    const bool exact = std::ranges::find(twins, copy) != twins.end();
    const std::string agrees = exact ? fmt::format("says exactly what the source '{}' says", copy)
                                     : fmt::format("agrees with the source '{}' as only a copy does", copy);
    fmt::print(stderr,
               "note: '{}' {}, and counts with it as one where other sources differ. If {}: roadfix remove {} {}\n",
               source, agrees,
               exact ? "it is the same content, take it out" : "one was made of the other, take the worse one out",
               shell_word(map), shell_word(source));
  }
}

/// A newer version mostly has a newer file name, and would count beside the older one.
std::optional<std::string> note_on_nothing_replaced(const std::string& map, const std::string& source) {
  constexpr std::size_t kNamed = 8;
  if (!std::filesystem::exists(map)) return std::nullopt;
  std::set<std::string> names;
  const MapReader reader(map);
  for (const SourceStatus& status : reader.info().sources) names.insert(status.record.name);
  if (names.empty() || names.contains(source)) return std::nullopt;
  const auto last = std::next(names.begin(), std::min(std::ssize(names), std::ptrdiff_t{kNamed}));
  return fmt::format(
      "--replace replaces nothing: the map has no source '{}', it has '{}'{}. If this is a newer version of one of "
      "them, take the older one out (roadfix remove); with its --name it would have been replaced",
      source, fmt::join(names.begin(), last, "', '"), last == names.end() ? "" : " and others");
}

/// New imagery of the worst quarter of a town is no newer version of the imagery of the town.
std::optional<std::string> note_on_ground_lost(const CellSource& newer, const std::string& map,
                                               const std::string& source, double cell_m) {
  constexpr std::ptrdiff_t kParts = 10;  // one of them may go: the edges of two pictures differ
  const std::set<TileIndex> blocks = MapWriter::blocks_of(map, source);
  const auto lost = std::ranges::count_if(
      blocks, [&](TileIndex block) { return !newer.touches(tile_geometry(block, cell_m).box()); });
  if (lost * kParts <= std::ssize(blocks)) return std::nullopt;
  const double block_km2 = std::pow(kTileCells * cell_m / 1e3, 2);
  return fmt::format(
      "--replace takes {:.1f} of {:.1f} km2 of the old '{}' out of the map, which this one does not cover. If it shows "
      "a part only, ingest it with another --name instead",
      static_cast<double>(lost) * block_km2, static_cast<double>(blocks.size()) * block_km2, source);
}

/// Of the source, and of those beside it, for which it may be the other side.
void note_shifts(const std::string& map, const std::string& source, const ShiftReport& shifts) {
  std::vector<std::string> names;
  for (const auto& [name, shift] : shifts.beside) names.insert(name == source ? names.begin() : names.end(), name);
  for (const std::string& name : names) {
    const double stated_m = MapWriter::records_of(map, name).front().provenance.registration_sigma_m;
    print_shift_note(name, shifts.beside.at(name), stated_m, name == names.front());
  }
  for (const std::string& note : shifts.notes) fmt::print(stderr, "note: {}\n", note);
}

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

void ingest_one(const IngestArguments& arguments, const SourceRequest& request, const MapSettings& settings,
                const RoadDetector* detector, std::optional<MapWriter>& writer, const std::stop_token& stop) {
  const PlannedSource planned = plan_source(request, settings, detector);
  const CellSource& source = *planned.cells;
  SourceSummary summary = summary_of(source, request.files);
  std::ranges::move(zone_notes(source, settings), std::back_inserter(summary.notes));
  if (auto note = note_on_distance(source, arguments.map)) summary.notes.push_back(std::move(*note));
  SourceRecord record = record_of(request.files, summary, arguments.options.seed);
  std::ranges::move(describe_source(record, summary.told, arguments.told,
                                    MapWriter::records_of(arguments.map, record.name), arguments.options.replace),
                    std::back_inserter(summary.notes));
  if (arguments.options.replace) {
    if (auto note = note_on_nothing_replaced(arguments.map, record.name)) summary.notes.push_back(std::move(*note));
    if (auto note = note_on_ground_lost(source, arguments.map, record.name, settings.cell_m))
      summary.notes.push_back(std::move(*note));
  }
  print_notes(request.files, summary);
  const nlohmann::json json = summary_json(record, summary, planned.blocks, settings);
  if (arguments.dry_run) {
    MapWriter::require_acceptable(arguments.map, settings, record, arguments.options.replace);
    const std::int64_t held = std::ssize(MapWriter::blocks_of(arguments.map, record));
    print_plan(json, planned.blocks - held, arguments.map, arguments.json);
    return;
  }
  if (!writer) writer.emplace(arguments.map, settings);
  IngestOptions options = arguments.options;
  options.stop = stop;
  const IngestReport report = ingest_with_progress(planned, summary, record, *writer, std::move(options));
  if (report.observed_cells == 0 && report.blocks_before == 0) {
    fmt::print(stderr, "note: nothing of {} was observed: {}\n", request.files.location,
               summary.is_lines() ? "its --extent holds the centre of no cell"
                                  : "all its pixels are nodata, transparent, no numbers or in one colour");
  }
  if (report.blocks_before < report.blocks) {
    note_copies(*writer, record.name, arguments.map, report.shifts);
  }
  note_shifts(arguments.map, record.name, report.shifts);
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
  for (const std::string& source : arguments.sources) requests.push_back(request_of(arguments, source));
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
  const MapSettings settings = settings_of(arguments, requests.front(), detector.get());
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
