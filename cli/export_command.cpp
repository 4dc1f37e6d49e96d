#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <system_error>

#include "cli/bbox_option.hpp"
#include "cli/command.hpp"
#include "cli/map_notes.hpp"
#include "cli/output_file.hpp"
#include "cli/terminal.hpp"
#include "core/geodesy/geo_box.hpp"
#include "core/units/error.hpp"
#include "core/units/text.hpp"
#include "tiles/export/map_export.hpp"

namespace roadfix::cli {
namespace {

struct ExportArguments {
  std::string map;
  std::string target;
  std::string format;
  std::optional<GeoBox> bbox;
  std::optional<double> cell_m;
};

/// That of the name of the target, where none was asked for.
ExportFormat format_of(const ExportArguments& options) {
  static const std::map<std::string, ExportFormat> kFormats{
      {"cog", ExportFormat::kCog},   {"gtiff", ExportFormat::kGeoTiff},    {"png", ExportFormat::kPng},
      {".tif", ExportFormat::kCog},  {"mbtiles", ExportFormat::kMbTiles},  {".png", ExportFormat::kPng},
      {".tiff", ExportFormat::kCog}, {".mbtiles", ExportFormat::kMbTiles},
  };
  const std::string ending = lower_case(std::filesystem::path(options.target).extension().string());
  const auto format = kFormats.find(options.format.empty() ? ending : options.format);
  if (format != kFormats.end()) return format->second;
  throw InvalidInput("export-format-unknown",
                     fmt::format("{}: its name does not say in which format: let it end in .tif, .png or .mbtiles, or "
                                 "give --format",
                                 options.target));
}

/// An export that fails leaves the file of before, since it is written beside it and renamed: no device takes that.
void require_file(const std::string& target) {
  namespace fs = std::filesystem;
  const bool is_device = fs::absolute(target).lexically_normal().string().starts_with("/dev/");
  std::error_code none;  // where it does not exist yet
  const bool is_other = fs::exists(target, none) && !fs::is_regular_file(target, none);
  if (target != "-" && !is_device && !is_other) return;
  throw InvalidInput("target-not-file",
                     fmt::format("{} is no file, and an export goes into a file only: name one (./- if that is its "
                                 "name)",
                                 target));
}

void run_export(const ExportArguments& options) {
  const std::stop_token stop = stop_on_signals();
  require_file(options.target);
  const MapReader map(options.map);
  note_unfinished(options.map, map.info());
  require_apart({options.target}, {options.map});
  ExportOptions what{.format = format_of(options), .cell_m = options.cell_m};
  if (options.bbox) what.box = grid_box_around(map.info().settings.zone, *options.bbox, map.info().extent);
  Progress progress("export", "%", 0.1);
  export_map(map, options.target, what, progress.updates(), stop);
}

}  // namespace

void add_export_command(CLI::App& app) {
  auto* command = app.add_subcommand("export", "Writes a map, or a region of it, for other programs");
  command->footer(
      "Examples: roadfix export adiyaman.gpkg adiyaman.tif\n"
      "          roadfix export adiyaman.gpkg centre.png --bbox 38.26,37.75,38.29,37.77");
  const auto options = std::make_shared<ExportArguments>();
  command->add_option("map", options->map, "Map file (GeoPackage)")->required();
  command->add_option("target", options->target, "File to write")->required();
  command->add_option("--format", options->format, "Default: from the file extension, cog for .tif")
      ->check(CLI::IsMember({"cog", "gtiff", "png", "mbtiles"}));
  add_bbox_option(*command, "Region", options->bbox);
  command->add_option("--cell", options->cell_m, "Cell size in metres: that of the map times a power of two");
  command->callback([options] { run_export(*options); });
}

}  // namespace roadfix::cli
