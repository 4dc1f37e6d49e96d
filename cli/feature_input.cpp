#include "cli/feature_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "cli/detector_options.hpp"
#include "core/detect/frame.hpp"
#include "core/detect/frame_image.hpp"
#include "core/detect/image_codec.hpp"
#include "core/units/error.hpp"

namespace roadfix::cli {
namespace {

constexpr std::int64_t kMostPixels = 400'000'000;
constexpr double kFarthestGroundM = 3000.0;

std::vector<std::uint8_t> bytes_of(const std::string& path) {
  if (std::filesystem::is_directory(path)) {
    throw InvalidInput("not-a-file", fmt::format("{} is a folder: name a PNG or JPEG file", path));
  }
  std::ifstream in(path, std::ios::binary);
  if (!in) throw NotFound("file-not-found", fmt::format("{} cannot be opened", path));
  return {std::istreambuf_iterator<char>(in), {}};
}

GroundView ground_seen(const FeatureInputOptions& options, const cv::Mat& decoded, const RoadDetector& detector) {
  if (options.gsd_m > 0.0) {
    return rectified(frame_image(decoded, options.gsd_m, options.black_unseen ? Border::kBlackUnseen : Border::kSeen));
  }
  constexpr double kAnyGsd = 1.0;  // follows from the camera
  const GroundImage frame = frame_image(decoded, kAnyGsd);
  FrameCamera camera;
  camera.horizontal_fov = Angle::degrees(options.fov_deg);
  camera.agl_m = options.agl_m;
  camera.roll = Angle::degrees(options.roll_deg);
  camera.pitch = Angle::degrees(options.pitch_deg);
  validate(camera);
  const double gsd_m = std::max(nominal_gsd_m(camera, frame.pixels.size()), 0.5 * detector.preferred_gsd_m());
  return rectify(frame.pixels, frame.observed, camera, gsd_m, kFarthestGroundM, static_cast<double>(kMostPixels));
}

}  // namespace

void add_feature_input_options(CLI::App& command, FeatureInputOptions& o) {
  command.add_option("input", o.path, "Feature map (PNG: grey = probability of road, alpha = observed) or frame")
      ->required();
  auto* cell = command.add_option("--cell,--cell-m", o.cell_m, "The input is a feature map: its cell size in metres")
                   ->check(CLI::PositiveNumber);
  auto* gsd = command.add_option("--gsd", o.gsd_m, "The input is a frame seen straight from above: metres per pixel")
                  ->check(CLI::PositiveNumber)
                  ->excludes(cell);
  auto* fov = command.add_option("--fov", o.fov_deg, "The input is a camera frame: field of view across, degrees")
                  ->check(CLI::PositiveNumber)
                  ->excludes(cell)
                  ->excludes(gsd);
  auto* agl = command.add_option("--agl", o.agl_m, "Altitude above ground in metres, with --fov")
                  ->check(CLI::PositiveNumber)
                  ->needs(fov);
  fov->needs(agl);
  command.add_option("--roll", o.roll_deg, "Roll of the camera in degrees, right side down")->needs(fov);
  command.add_option("--pitch", o.pitch_deg, "Pitch of the camera in degrees, nose up")->needs(fov);
  command.add_flag("--black-unseen", o.black_unseen, "Black areas at the frame's rim were not seen")->needs(gsd);
  command.add_option("--seed", o.seed, "Of detectors that draw random numbers")->capture_default_str();
  add_detector_options(command, o.detector);
}

FeatureInput read_feature_input(const FeatureInputOptions& options, double map_cell_m) {
  if (options.cell_m <= 0.0 && options.gsd_m <= 0.0 && options.fov_deg <= 0.0) {
    throw InvalidInput("input-kind-missing",
                       "say what the input is: --cell for a feature map, --gsd or --fov and --agl for a frame");
  }
  const std::vector<std::uint8_t> bytes = bytes_of(options.path);
  if (options.cell_m > 0.0) {
    return {FeatureMap::centred(decode_feature_map(bytes, kMostPixels), options.cell_m), {}};
  }
  const auto detector = make_detector(options.detector);
  const auto start = std::chrono::steady_clock::now();
  const GroundView view = ground_seen(options, decode_image(bytes, kMostPixels), *detector);
  FeatureMap features = detect_features(*detector, view, map_cell_m, options.seed);
  return {std::move(features), std::chrono::steady_clock::now() - start};
}

}  // namespace roadfix::cli
