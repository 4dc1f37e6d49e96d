#include "cli/frame_options.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <string>

#include "cli/limits.hpp"
#include "cli/number_checks.hpp"
#include "cli/picture_files.hpp"
#include "cli/unit_options.hpp"
#include "core/detect/feature_map_codec.hpp"
#include "core/detect/image_codec.hpp"
#include "core/units/bytes.hpp"
#include "core/units/error.hpp"
#include "core/units/file.hpp"
#include "server/api/frame_scale.hpp"

namespace roadfix::cli {
namespace {

std::string read_picture(const std::string& path) {
  if (std::filesystem::is_directory(path)) {
    throw InvalidInput("not-a-file", fmt::format("{} is a folder: name a PNG or JPEG file", path));
  }
  require_not_empty(path);
  return read_named_file(path);
}

auto decoded(const std::string& path, const auto& decode) {
  const std::string picture = read_picture(path);
  return said_of(path, [&] { return decode(bytes_of(picture)); });
}

FrameCamera told_camera(const FrameCamera& camera) {
  if (!camera.horizontal_fov && !camera.focal_px) throw CLI::RequiredError("--fov or --focal-px");
  return camera;
}

api::FrameScale scale_of(const std::string& path, const FrameOptions& options) {
  if (options.camera_in_file) {
    const FrameCamera& told = options.camera;
    const KnownView known{told.agl_m > 0.0 ? std::optional(told.agl_m) : std::nullopt, told.roll, told.pitch,
                          options.takeoff_agl_m, told.attitude_sigma};
    return decoded(path, [&](Bytes bytes) { return api::scale_in_file(bytes, known); });
  }
  if (!options.has_camera()) return {StraightDown{options.gsd_m}};
  return {told_camera(options.camera)};
}

}  // namespace

std::vector<CLI::Option*> add_frame_options(CLI::App& command, FrameOptions& o) {
  auto* gsd =
      command
          .add_option("--gsd", o.gsd_m,
                      "The input is a rectified frame, as if seen straight from above: metres per pixel. For a camera "
                      "that may lean give its lens and --agl")
          ->check(positive());
  auto* fov = add_degrees_option(command, "--fov", o.camera.horizontal_fov,
                                 "The input is a camera frame: field of view across, degrees")
                  ->check(positive());
  auto* focal = command
                    .add_option("--focal-px", o.camera.focal_px,
                                "The input is a camera frame: focal length in pixels, as a calibration gives it")
                    ->check(positive())
                    ->excludes(fov);
  auto* agl =
      command.add_option("--agl", o.camera.agl_m, "Altitude above ground in metres, with --fov, --focal-px or --exif")
          ->check(positive())
          ->excludes(gsd);
  auto* exif =
      command
          .add_flag(
              "--exif", o.camera_in_file,
              "The input is a frame as a drone stored it: its EXIF and XMP tell lens, height above the "
              "take-off, roll and pitch; --agl, --roll and --pitch say otherwise, or what it does not tell. Digital "
              "zoom is refused")
          ->excludes(gsd)
          ->excludes(fov)
          ->excludes(focal);
  add_degrees_option(command, "--roll", o.camera.roll,
                     "Roll of the camera in degrees, positive with the right side down; 0 = straight down");
  add_degrees_option(command, "--pitch", o.camera.pitch,
                     "Pitch of the camera in degrees, positive with the nose up; 0 = straight down (a gimbal's -90)");
  add_degrees_option(command, "--attitude-sigma", o.camera.attitude_sigma,
                     "How well roll and pitch of the camera are known, 1 sigma each in degrees (default: 1 where both "
                     "are told, else 5). Ground so far off that this misplaces it by 10 m is left out")
      ->check(positive(kLargestAttitudeSigma.degrees()));
  const auto set_principal = [&o](const std::vector<double>& at) { o.camera.principal_px.emplace(at[0], at[1]); };
  command
      .add_option_function<std::vector<double>>("--principal-px", set_principal,
                                                "Principal point in pixels (default: the middle of the frame)")
      ->type_name("X,Y")
      ->delimiter(',')
      ->expected(2)
      ->needs(focal);
  command
      .add_option("--distortion", o.camera.distortion,
                  "Lens distortion by OpenCV's model (ROS: plumb_bob, rational_polynomial), of --fisheye K1,K2,K3,K4")
      ->type_name("K1,K2,P1,P2[,K3[,K4,K5,K6]]")
      ->delimiter(',')
      ->expected(4, 8)
      ->needs(focal);
  command
      .add_flag_callback(
          "--fisheye", [&o] { o.camera.lens = LensModel::kFisheye; },
          "The lens is a fisheye (OpenCV's model; ROS: equidistant)")
      ->needs(focal);
  command.add_flag_callback(
      "--black-unseen", [&o] { o.border = Border::kBlackUnseen; }, "Black areas at the frame's edge were not seen");
  return {gsd, agl, exif};
}

void require_frame_for(const FrameOptions& options) {
  const bool tells_lens = options.camera.horizontal_fov || options.camera.focal_px;
  if (tells_lens && !options.has_camera())
    throw CLI::RequiredError("with --fov or --focal-px: --agl (for a fix also --alt)");
  if (options.border == Border::kBlackUnseen && !options.given())
    throw CLI::RequiredError("with --black-unseen one of --gsd, --exif and --agl");
  if ((options.camera.roll || options.camera.pitch || options.camera.attitude_sigma) && !options.has_camera())
    throw CLI::RequiredError("with --roll, --pitch or --attitude-sigma: --exif or --agl (for a fix also --alt)");
}

api::SeenFrame ground_seen(const FrameOptions& options, const std::string& path, const RoadDetector& detector) {
  const cv::Mat pixels = decoded(path, [](Bytes bytes) { return decode_frame(bytes, kMaxPixels); });
  const api::Frame frame{pixels, scale_of(path, options), options.border};
  return said_of(path, [&] { return api::seen_frame(frame, detector, kMaxPixels); });
}

api::AboveTakeoff above_takeoff(const std::string& path, double takeoff_alt_m, const api::AglOf& agl_of) {
  return decoded(path, [&](Bytes bytes) { return api::above_takeoff(bytes, takeoff_alt_m, agl_of); });
}

FoundFeatureMap feature_map_in(const std::string& path, const ToldScale& told) {
  return decoded(path, [&](Bytes bytes) {
    if (!told.cell_m && !is_feature_map(bytes)) {
      throw InvalidInput(
          "input-kind-missing",
          "say what the input is: --cell for a feature map that does not tell its cell size itself; --gsd, "
          "--exif or --agl with --fov or --focal-px for a frame");
    }
    FeatureMapPicture picture = decode_feature_map(bytes, kMaxPixels);
    std::string reader = picture.scale ? picture.scale->reader : "";
    return FoundFeatureMap{feature_map_of(std::move(picture), told), std::move(reader)};
  });
}

}  // namespace roadfix::cli
