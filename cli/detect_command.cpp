#include "cli/command.hpp"

#include <fmt/format.h>

#include <cstddef>
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
#include "cli/map_notes.hpp"
#include "cli/number_checks.hpp"
#include "cli/output_file.hpp"
#include "cli/picture_files.hpp"
#include "cli/word_option.hpp"
#include "core/detect/detectors.hpp"
#include "core/detect/feature_map_codec.hpp"
#include "core/detect/image_codec.hpp"
#include "core/grid/cell_moments.hpp"
#include "core/units/bytes.hpp"
#include "core/units/error.hpp"
#include "core/units/file.hpp"
#include "core/units/json_text.hpp"
#include "core/units/text.hpp"
#include "server/api/feature_json.hpp"
#include "tiles/export/side_files.hpp"
#include "tiles/imagery/read_orthoimage.hpp"

namespace roadfix::cli {
namespace {

struct DetectOptions {
  DetectorChoice detector;
  std::optional<SourceContent> compared;  ///< nullopt = imagery
  std::vector<std::string> names;         ///< pictures, then the target
  FrameOptions frame;
  double cell_m = 2.0;
  std::uint64_t seed = 1;
  bool json = false;
};

/// A picture, and where its feature map goes.
struct Job {
  std::string image;
  std::string target;
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

/// Where the target was forgotten, the last frame is not to be lost.
void require_no_other_picture(const std::string& target) {
  if (!std::filesystem::is_regular_file(target) || is_standard_output(target)) return;
  const std::string there = read_file(target).value_or("");
  if (!read_image_header(bytes_of(there)) || is_feature_map(bytes_of(there))) return;
  throw InvalidInput("target-is-picture",
                     fmt::format("{} is a picture and no feature map of roadfix: the last name is what gets written, "
                                 "so name a new file or a folder",
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

/// Most pictures that do not tell where they lie are frames whose camera was not told.
UtmZone zone_of_picture(const std::string& image) {
  try {
    return zone_of_image(image);
  } catch (const InvalidInput& error) {
    if (error.code() != "image-without-georeference") throw;
    throw InvalidInput(
        error.code(),
        fmt::format("{}. Of a frame tell the scale: --gsd, --exif, or --agl with --fov or --focal-px", error.what()));
  }
}

Picture read_picture(const DetectOptions& options, const std::string& image, const RoadDetector& detector) {
  if (options.frame.given()) return {ground_seen(options.frame, image, detector), {}};
  require_not_empty(image);
  const UtmZone zone = zone_of_picture(image);
  Orthoimage ortho = read_orthoimage(image, zone);
  return {{vertical_view(std::move(ortho.image))}, Place{zone, ortho.north_west}};
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
void require_own_world_file(const Job& job) {
  namespace fs = std::filesystem;
  const fs::path world = fs::absolute(common_world_file(job.target)).lexically_normal();
  if (fs::absolute(common_world_file(job.image)).lexically_normal() != world || !fs::exists(world)) return;
  throw InvalidInput("target-is-source",
                     fmt::format("{} belongs to {}, and would be taken for that of {}: name another file",
                                 world.string(), job.image, job.target));
}

nlohmann::json json_of(const Job& job, const api::Features& features) {
  nlohmann::json answer = api::detection_json(features);
  answer["image"] = job.image;
  answer["feature_map"] = job.target;
  const CellMoments moments = moments_of(features.map.cells);
  answer["observed_cells"] = moments.count;
  answer["mean_probability"] = moments.mean();
  return answer;
}

std::string text_of(const Job& job, const api::Features& features) {
  const FeatureMap& map = features.map;
  const CellMoments moments = moments_of(map.cells);
  return fmt::format(
      "{}: {} x {} cells of {} m, {} observed, mean probability of road {:.3f}, {:.0f} ms\n"
      "UAV above column {:.1f}, row {:.1f}{}\n{}",
      job.target, map.cells.cols(), map.cells.rows(), map.cell_m, moments.count, moments.mean(),
      features.detect_time.value().count(), map.nadir.col, map.nadir.row,
      map.nadir_sigma_m > 0.0 ? fmt::format(", known to {:.1f} m (1 sigma per axis) and {:.1f} degrees",
                                            map.nadir_sigma_m, map.nadir_heading_sigma.degrees())
                              : "",
      features.detector.value());
}

std::unique_ptr<RoadDetector> detector_of(const DetectOptions& options) {
  if (options.compared && is_one_for_both(options.detector)) {
    throw InvalidInput(
        "option-without-effect",
        "--compare-with does nothing where one detector reads for both: the tree, the network of --model "
        "or ROADFIX_MODEL, or the only one that is installed: leave it out");
  }
  note_missing_network(options.detector);
  return make_detector(options.detector, options.compared.value_or(SourceContent::kImagery));
}

void detect(const DetectOptions& options, const Job& job, const RoadDetector& detector) {
  require_apart({job.target}, {job.image});
  require_no_other_picture(job.target);
  require_own_world_file(job);
  const Picture picture = read_picture(options, job.image, detector);
  const api::Features features = api::detected(picture.frame, {detector, options.cell_m, {}, options.seed});
  const FeatureMap& map = features.map;
  if (!map.cells.any_observed()) {
    throw InvalidInput("image-unobserved", fmt::format("{}: no pixel of it was seen", job.image));
  }
  const std::vector<std::uint8_t> png = encode_feature_map(map, detector.describe());
  write_file(job.target, characters_of(png));
  if (std::filesystem::is_regular_file(job.target) && !is_standard_output(job.target)) {
    remove_side_files(job.target);
    if (picture.place) write_place(job.target, *picture.place, options.cell_m);
  }
  std::FILE* out = printed_beside({job.target});
  if (options.json) {
    nlohmann::json answer = json_of(job, features);
    if (picture.place) answer["crs"] = fmt::format("EPSG:{}", picture.place->zone.epsg());
    fmt::print(out, "{}\n", json_text(answer));
  } else {
    fmt::print(out, "{}\n", text_of(job, features));
  }
}

std::string target_in(const std::filesystem::path& folder, const std::filesystem::path& image) {
  return (folder / image.stem()).string() + ".png";
}

/// No feature map goes over another one, nor over a picture that is read later.
void require_own_targets(const std::filesystem::path& folder, const std::vector<std::filesystem::path>& images) {
  namespace fs = std::filesystem;
  std::map<fs::path, fs::path> taken;  // by what
  for (const fs::path& image : images) taken.emplace(fs::weakly_canonical(image), image);
  for (const fs::path& image : images) {
    const fs::path target = target_in(folder, image);
    const auto [other, is_own] = taken.emplace(fs::weakly_canonical(target), image);
    if (is_own) continue;
    throw InvalidInput("target-given-twice",
                       fmt::format("{} would go to {}, which is also of {}: name another folder, or rename one of them",
                                   image.string(), target.string(), other->second.string()));
  }
}

void detect_all(const DetectOptions& options, const Pictures& pictures, const std::string& target) {
  require_name(target);
  if (std::filesystem::exists(target) && !std::filesystem::is_directory(target)) {
    throw InvalidInput("target-not-folder",
                       fmt::format("{} is no folder: of several pictures the feature maps go into a folder, which is "
                                   "the last name",
                                   target));
  }
  require_own_targets(target, pictures.files);
  std::filesystem::create_directories(target);
  const auto detector = detector_of(options);
  const std::size_t left_out = for_each_picture(pictures, "detecting", true, [&](const std::filesystem::path& image) {
    detect(options, {image.string(), target_in(target, image)}, *detector);
  });
  require_none(left_out, pictures.files.size());
}

void run_detect(const DetectOptions& options) {
  require_frame_for(options.frame);
  const Pictures pictures = pictures_of({options.names.begin(), options.names.end() - 1}, kPictureEndings);
  const std::string& target = options.names.back();
  if (pictures.several || std::filesystem::is_directory(target)) {
    detect_all(options, pictures, target);
    return;
  }
  const std::filesystem::path& picture = pictures.files.front();
  require_apart({target}, {picture});
  require_png_name(target);
  detect(options, {picture.string(), target}, *detector_of(options));
}

}  // namespace

void add_detect_command(CLI::App& app) {
  auto* command = app.add_subcommand("detect", "Detects the roads of pictures: feature maps as PNG");
  command->footer(
      "Examples: roadfix detect frame.png roads.png --gsd 0.5\n"
      "          roadfix detect frame.jpg roads.png --fov 73 --agl 120 --pitch 4\n"
      "          roadfix detect ortho.tif roads.png   (north up, with a world file)\n"
      "          roadfix detect photos/ roads/ --exif   (roads/ gets a PNG of the name of each photo)\n"
      "Exit code: 0 done, 1 where a picture could not be used, 2 for wrong usage. Of several pictures the others are "
      "done.");
  const auto options = std::make_shared<DetectOptions>();
  command
      ->add_option(
          "pictures", options->names,
          "Frames (PNG or JPEG, with --gsd, --exif or --fov and --agl), or any georeferenced images, or folders "
          "of PNG and JPEG; then what to write: a PNG (grey = probability, alpha = observed), or of several "
          "pictures a folder for one each")
      ->option_text("IMAGE... TARGET REQUIRED")
      ->required()
      ->expected(2, -1);
  add_frame_options(*command, options->frame);
  command->add_option("--cell", options->cell_m, "Cell size in metres")
      ->capture_default_str()
      ->check(between(0.1, 100.0));
  command->add_option("--seed", options->seed, "Seed of detectors that use random numbers")
      ->capture_default_str()
      ->check(seed());
  command->add_flag("--json", options->json, "Answer as JSON");
  add_word_option(*command, "--compare-with", kSourceContents, options->compared,
                  "What the map shows that the feature map is for: imagery (default) or roads, that is road data. Each "
                  "has its network");
  add_detector_options(*command, options->detector);
  command->callback([options] { run_detect(*options); });
}

}  // namespace roadfix::cli
