#include "cli/command.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/detector_options.hpp"
#include "cli/frame_options.hpp"
#include "cli/number_checks.hpp"
#include "cli/output_file.hpp"
#include "core/detect/feature_map_codec.hpp"
#include "core/units/error.hpp"
#include "core/units/json_text.hpp"
#include "core/units/text.hpp"
#include "tiles/export/side_files.hpp"
#include "tiles/sources/read_orthoimage.hpp"

namespace roadfix::cli {
namespace {

struct DetectOptions {
  DetectorChoice detector;
  ComparedWith compared = ComparedWith::kImagery;
  std::string image;
  std::string target;
  FrameOptions frame;
  double cell_m = 2.0;
  std::uint64_t seed = 1;
  bool json = false;
};

/// Devices have names without an ending, and take a PNG too.
void require_png_name(const std::string& target) {
  const std::string ending = lower_case(std::filesystem::path(target).extension().string());
  if (ending.empty() || ending == ".png") return;
  throw InvalidInput("feature-map-not-png",
                     fmt::format("{}: a feature map is a PNG, whose alpha says what was observed: let its name end in "
                                 ".png; gdal_translate makes other formats of it",
                                 target));
}

/// Where the first cell of a georeferenced picture lies.
struct Place {
  UtmZone zone;
  GridPoint north_west;
};

struct Picture {
  api::SeenFrame frame;
  std::optional<Place> place;
};

Picture read_picture(const DetectOptions& options, const RoadDetector& detector) {
  require_frame_for(options.frame);
  if (options.frame.given()) {
    return {ground_seen(options.frame, options.image, detector), {}};
  }
  const UtmZone zone = zone_of_image(options.image);
  Orthoimage ortho = read_orthoimage(options.image, zone);
  return {{rectified(std::move(ortho.image))}, Place{zone, ortho.north_west}};
}

/// World file and reference system beside the PNG, as GDAL and QGIS look for them.
void write_place(std::filesystem::path png, const Place& place, double cell_m) {
  write_file(png.string() + ".aux.xml",
             fmt::format("<PAMDataset>\n  <SRS>EPSG:{}</SRS>\n</PAMDataset>\n", place.zone.epsg()));
  write_file(png.replace_extension(".pgw"),
             fmt::format("{}\n0\n0\n{}\n{:.3f}\n{:.3f}\n", cell_m, -cell_m, place.north_west.east_m + 0.5 * cell_m,
                         place.north_west.north_m - 0.5 * cell_m));
}

/// Where picture and target differ in their endings alone, one world file would serve both: the picture's is neither
/// taken away nor left to say where a frame lies.
void require_own_world_file(const DetectOptions& options) {
  namespace fs = std::filesystem;
  const fs::path world = fs::absolute(common_world_file(options.target)).lexically_normal();
  if (fs::absolute(common_world_file(options.image)).lexically_normal() != world || !fs::exists(world)) return;
  throw InvalidInput("target-is-source",
                     fmt::format("{} belongs to {}, and would be taken for that of {}: name another file",
                                 world.string(), options.image, options.target));
}

double mean_probability(const CellArray& cells) {
  double sum = 0.0;
  for (const Cell cell : cells.cells()) {
    if (is_observed(cell)) sum += probability(cell);
  }
  return cells.observed_count() == 0 ? 0.0 : sum / static_cast<double>(cells.observed_count());
}

using Milliseconds = std::chrono::duration<double, std::milli>;

nlohmann::json json_of(const DetectOptions& options, const FeatureMap& map, const std::string& detector,
                       Milliseconds time) {
  return {{"feature_map", options.target},
          {"cell_m", options.cell_m},
          {"cols", map.cells.cols()},
          {"rows", map.cells.rows()},
          {"nadir_cell", {map.nadir.col, map.nadir.row}},
          {"nadir_sigma_m", map.nadir_sigma_m},
          {"nadir_heading_sigma_deg", map.nadir_heading_sigma.degrees()},
          {"observed_cells", map.cells.observed_count()},
          {"mean_probability", mean_probability(map.cells)},
          {"detector", detector},
          {"time_ms", time.count()}};
}

std::string text_of(const DetectOptions& options, const FeatureMap& map, const std::string& detector,
                    Milliseconds time) {
  return fmt::format(
      "{}: {} x {} cells of {} m, {} observed, mean probability of road {:.3f}, {:.0f} ms\n"
      "UAV above column {:.1f}, row {:.1f}{}\n{}",
      options.target, map.cells.cols(), map.cells.rows(), options.cell_m, map.cells.observed_count(),
      mean_probability(map.cells), time.count(), map.nadir.col, map.nadir.row,
      map.nadir_sigma_m > 0.0 ? fmt::format(", known to {:.1f} m (1 sigma per axis) and {:.1f} degrees",
                                            map.nadir_sigma_m, map.nadir_heading_sigma.degrees())
                              : "",
      detector);
}

void run_detect(const DetectOptions& options) {
  require_apart({options.target}, {options.image});
  require_png_name(options.target);
  require_own_world_file(options);
  const auto detector = make_detector(options.detector, options.compared);
  const Picture picture = read_picture(options, *detector);
  const api::Features features = api::detected(picture.frame, {*detector, options.cell_m, {}, options.seed});
  const FeatureMap& map = features.map;
  const auto time = features.detect_time.value();
  if (map.cells.observed_count() == 0) {
    throw InvalidInput("image-unobserved", fmt::format("{}: no pixel of it was seen", options.image));
  }
  const std::vector<std::uint8_t> png = encode_feature_map(map);
  write_file(options.target, {reinterpret_cast<const char*>(png.data()), png.size()});
  if (std::filesystem::is_regular_file(options.target) && !is_standard_output(options.target)) {
    remove_side_files(options.target);
    if (picture.place) write_place(options.target, *picture.place, options.cell_m);
  }
  std::FILE* out = printed_beside({options.target});
  if (options.json) {
    nlohmann::json answer = json_of(options, map, detector->describe(), time);
    if (picture.place) answer["crs"] = fmt::format("EPSG:{}", picture.place->zone.epsg());
    fmt::print(out, "{}\n", json_text(answer));
  } else {
    fmt::print(out, "{}\n", text_of(options, map, detector->describe(), time));
  }
}

}  // namespace

void add_detect_command(CLI::App& app) {
  auto* command = app.add_subcommand("detect", "Detects the roads of one picture: a feature map as PNG");
  command->footer(
      "Examples: roadfix detect frame.png roads.png --gsd 0.5\n"
      "          roadfix detect frame.jpg roads.png --fov 73 --agl 120 --pitch 4\n"
      "          roadfix detect ortho.tif roads.png   (north up, with a world file)");
  const auto options = std::make_shared<DetectOptions>();
  command
      ->add_option("image", options->image,
                   "Frame (PNG or JPEG, with --gsd, --exif or --fov and --agl), or any georeferenced image")
      ->required();
  command->add_option("target", options->target, "PNG to write: grey = probability, alpha = observed")->required();
  add_frame_options(*command, options->frame);
  command->add_option("--cell", options->cell_m, "Cell size in metres")
      ->capture_default_str()
      ->check(between(0.1, 100.0));
  command->add_option("--seed", options->seed, "Seed of detectors that use random numbers")
      ->capture_default_str()
      ->check(seed());
  command->add_flag("--json", options->json, "Answer as JSON");
  command
      ->add_option("--compare-with", options->compared,
                   "What the map shows that the feature map is for: imagery (default) or roads, that is road data. "
                   "Each has its network")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, ComparedWith>{{std::string(kComparedWithNames[0]), ComparedWith::kImagery},
                                              {std::string(kComparedWithNames[1]), ComparedWith::kRoads}}));
  add_detector_options(*command, options->detector);
  command->callback([options] { run_detect(*options); });
}

}  // namespace roadfix::cli
