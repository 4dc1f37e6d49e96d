#include "cli/ingest_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>

#include "cli/date_check.hpp"
#include "cli/number_checks.hpp"
#include "cli/threads_option.hpp"
#include "cli/word_option.hpp"
#include "core/units/error.hpp"
#include "core/units/file.hpp"
#include "core/units/provenance.hpp"

namespace roadfix::cli {
namespace {

RoadRules rules_of(const IngestArguments& arguments) {
  RoadRules rules;
  if (!arguments.rules_file.empty()) {
    rules = RoadRules::parse(read_named_file(arguments.rules_file));
  }
  if (!arguments.classes.empty()) rules.select(arguments.classes);
  if (!arguments.class_attribute.empty()) rules.set_class_attribute(arguments.class_attribute);
  if (!arguments.width_attribute.empty()) rules.set_width_attribute(arguments.width_attribute);
  if (arguments.width_m) rules.set_width_m(*arguments.width_m);
  return rules;
}

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
  command.add_option("--layer", a.vectors.layer, "Only this layer of vector files");
  command.add_option("--extent", a.vectors.extent,
                     "Ground that road lines cover: W,S,E,N in degrees, or a file with polygons (GeoJSON, .poly, ...)");
  command.add_option("--classes", a.classes, "Draw exactly these road classes, comma-separated");
  command.add_option("--rules", a.rules_file,
                     "Table of road classes in place of the built-in one: lines 'class width_m yes|no'");
  command.add_option("--class-attribute", a.class_attribute,
                     "Attribute with the road class; default: highway, fclass, type, class or road_class");
  command.add_option("--width-attribute", a.width_attribute,
                     "Attribute that holds the width in metres; NAME:ft if in feet");
  command.add_option("--width", a.width_m, "Width of all roads in metres")->check(between(0.5, 100.0));
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
  request.files = find_source(source, arguments.content, arguments.vectors.layer);
  if (!arguments.name.empty()) request.files.name = arguments.name;
  request.raster.crs = arguments.crs;
  if (!arguments.collar.empty()) request.raster.collar = parse_colour(arguments.collar);
  request.vectors = arguments.vectors;
  request.vectors.crs = arguments.crs;
  request.rules = rules_of(arguments);
  return request;
}

void refuse_without_effect(const IngestArguments& a, std::span<const SourceRequest> requests) {
  const auto lines = std::ranges::count(requests, SourceKind::kRoadVectors, [](const auto& r) { return r.files.kind; });
  const auto refuse = [&](bool given, const char* option, const char* why) {
    if (!given) return;
    throw InvalidInput("option-without-effect",
                       fmt::format("{} does nothing with {}: {}", option, requests.front().files.location, why));
  };
  if (lines == std::ssize(requests)) {
    refuse(!a.collar.empty(), "--nodata-color", "lines have no collar");
  }
  if (std::ranges::none_of(requests, [](const auto& r) { return r.files.kind == SourceKind::kImagery; })) {
    constexpr const char* kRoads = "it is about finding roads in imagery, and these are roads already";
    const DetectorChoice usual;
    refuse(a.detector.name != usual.name, "--detector", kRoads);
    refuse(a.detector.model != usual.model, "--model", kRoads);
    refuse(a.detector.orientations.has_value(), "--orientations", kRoads);
    refuse(a.detector.tree != usual.tree, "--tree-...", kRoads);
  }
  if (lines > 0) return;
  refuse(!a.vectors.extent.empty(), "--extent",
         "it says what ground lines cover, and these are pixels. To ingest a part of them, cut them before "
         "(gdalwarp -te)");
  constexpr const char* kPixels = "it is about road lines, and these are pixels";
  refuse(!a.vectors.layer.empty(), "--layer", kPixels);
  refuse(!a.classes.empty(), "--classes", kPixels);
  refuse(!a.rules_file.empty(), "--rules", kPixels);
  refuse(!a.class_attribute.empty(), "--class-attribute", kPixels);
  refuse(!a.width_attribute.empty(), "--width-attribute", kPixels);
  refuse(a.width_m.has_value(), "--width", kPixels);
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
