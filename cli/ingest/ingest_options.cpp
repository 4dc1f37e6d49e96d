#include "cli/ingest/ingest_options.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>

#include "cli/date_check.hpp"
#include "cli/number_checks.hpp"
#include "cli/threads_option.hpp"
#include "cli/word_option.hpp"
#include "core/units/provenance.hpp"

namespace roadfix::cli {
namespace {

void add_content_options(CLI::App& command, IngestArguments& a) {
  constexpr std::array<Word<std::optional<SourceContent>>, 3> kContents{
      {{"auto", std::nullopt}, {"imagery", SourceContent::kImagery}, {"roads", SourceContent::kRoads}}};
  add_word_option(command, "--as", kContents, a.content,
                  "What the sources are; auto: vectors and what roadfix wrote are roads, other rasters imagery")
      ->default_str("auto");
  command.add_option("--name", a.name, "Name of the source in the map; default: stem of the file, name of the folder");
  command.add_option("--crs", a.crs, "Reference system of the sources, if the files have none or a wrong one");
  command.add_option(
      "--nodata-color", a.collar,
      "Colour of the collar around the imagery: white, black or R,G,B; for one that does not fill a corner");
  add_road_options(command, a.roads);
}

/// Whose empty text is one, too.
CLI::Option* add_text(CLI::App& command, const char* name, std::optional<std::string>& text, const char* what) {
  return command.add_option_function<std::string>(
      name, [&text](const std::string& said) { text = said; }, what);
}

void add_provenance_options(CLI::App& command, IngestArguments& a) {
  add_text(command, "--date", a.told.date,
           "Date of the content, ISO 8601: 2023, 2023-02, 2023-02-06 or 2023-02-06T10:30Z; \"\": none")
      ->check(iso_date());
  add_text(command, "--licence", a.told.licence, "Licence of the content; \"\": none");
  add_text(command, "--attribution", a.told.attribution, "Attribution that the licence asks for; \"\": none");
  command
      .add_option(
          "--registration-sigma", a.told.registration_sigma_m,
          "Uncertainty of the position, 1 sigma in metres; default: 2.5 for imagery, 3 for rasters of roads, 4 for "
          "vectors, more with control points or RPC")
      ->check(positive());
}

}  // namespace

SourceRequest request_of(const IngestArguments& arguments, const std::string& source) {
  SourceRequest request;
  request.files = find_source(source, arguments.content, arguments.roads.lines.layer);
  if (!arguments.name.empty()) request.files.name = arguments.name;
  request.raster.crs = arguments.crs;
  if (!arguments.collar.empty()) request.raster.collar = parse_colour(arguments.collar);
  request.vectors = arguments.roads.lines;
  request.vectors.crs = arguments.crs;
  request.rules = rules_of(arguments.roads);
  return request;
}

void refuse_without_effect(const IngestArguments& a, std::span<const SourceRequest> requests) {
  const auto lines = std::ranges::count(requests, SourceKind::kRoadVectors, [](const auto& r) { return r.files.kind; });
  const std::string& source = requests.front().files.location;
  if (lines == std::ssize(requests)) refuse_option(!a.collar.empty(), "--nodata-color", source, "lines have no collar");
  if (std::ranges::none_of(requests, [](const auto& r) { return r.files.kind == SourceKind::kImagery; })) {
    constexpr const char* kRoads = "it is about finding roads in imagery, and these are roads already";
    const DetectorChoice usual;
    refuse_option(a.detector.name != usual.name, "--detector", source, kRoads);
    refuse_option(a.detector.model != usual.model, "--model", source, kRoads);
    refuse_option(a.detector.orientations.has_value(), "--orientations", source, kRoads);
    refuse_option(a.detector.tree != usual.tree, "--tree-...", source, kRoads);
  }
  if (lines == 0) refuse_for_pixels(a.roads, source);
}

void add_ingest_options(CLI::App& command, IngestArguments& a) {
  command
      .add_option("SOURCE", a.sources,
                  "Files, or folders of images or vector files (one source each; where images of a folder overlap, the "
                  "first by name is used)")
      ->required();
  command.add_option("--map", a.map, "The map file to create or extend")->required();
  command.add_option("--cell", a.cell_m, "Cell size of a new map in metres; default: 2")
      ->check(CLI::IsMember({0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0}));
  command.add_option("--zone", a.zone, "UTM zone of a new map, EPSG:326zz or 327zz; default: that of the first source");
  add_content_options(command, a);
  add_detector_options(command, a.detector, kMapOrientations);
  add_provenance_options(command, a);
  add_threads_option(command, "--jobs", a.options.jobs, "Blocks in progress at a time");
  command.add_option("--seed", a.options.seed, "Seed of the detector's random numbers; default: 1")->check(seed());
  command.add_flag("--replace", a.options.replace, "Replace a source of the same name and its metadata");
  command.add_flag("--dry-run", a.dry_run, "Print the plan and stop");
  command.add_flag("--json", a.json, "Print one line of JSON for each source");
}

}  // namespace roadfix::cli
