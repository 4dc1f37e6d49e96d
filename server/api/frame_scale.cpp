#include "server/api/frame_scale.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>

#include "core/detect/frame.hpp"
#include "core/units/words.hpp"
#include "server/http/errors.hpp"

namespace roadfix::api {
namespace {

using http::InvalidField;

constexpr Range kGsd{kFinestGsdM, kCoarsestGsdM};
constexpr Range kQuarterTurn{-90.0, 90.0};
constexpr Range kAttitudeSigma{0.0, kLargestAttitudeSigma.degrees(), true};
constexpr std::array<Word<LensModel>, 2> kLenses{
    {{"perspective", LensModel::kPerspective}, {"fisheye", LensModel::kFisheye}}};

const std::vector<std::string>& lens_fields() {
  static const std::vector<std::string> kFields{"fov_deg", "focal_px", "principal_px", "lens", "distortion"};
  return kFields;
}

const std::vector<std::string>& view_fields() {
  static const std::vector<std::string> kFields{"agl_m", "roll_deg", "pitch_deg", "attitude_sigma_deg"};
  return kFields;
}

void refuse(const Fields& fields, const std::vector<std::string>& names, std::string_view why) {
  for (const std::string& name : names) {
    if (fields.has(name)) {
      throw InvalidField("bad-parameter", name, fmt::format("'{}' cannot be combined with {}", name, why));
    }
  }
}

std::optional<Angle> told_attitude_sigma(const Fields& fields) {
  return fields.optional_angle("attitude_sigma_deg", kAttitudeSigma);
}

FrameCamera told_camera(const Fields& fields) {
  FrameCamera camera;
  camera.horizontal_fov = fields.optional_angle("fov_deg", kFieldOfView);
  camera.focal_px = fields.optional_number("focal_px", kPositive);
  if (camera.horizontal_fov) refuse(fields, {"focal_px"}, "fov_deg: the focal length tells how wide the lens sees");
  if (!camera.horizontal_fov && !camera.focal_px) {
    throw InvalidField("missing-parameter", "fov_deg",
                       "a frame needs gsd_m, or agl_m with one of fov_deg and focal_px, or exif=true where its file "
                       "tells the camera");
  }
  camera.lens = fields.choice("lens", kLenses);
  if (const auto principal = fields.optional_numbers("principal_px", 2)) {
    camera.principal_px = cv::Point2d(principal->at(0), principal->at(1));
  }
  camera.distortion = fields.optional_numbers("distortion", 4, 8).value_or(std::vector<double>());
  camera.agl_m = fields.number("agl_m", kHeightAboveGround);
  camera.roll = fields.optional_angle("roll_deg", kQuarterTurn);
  camera.pitch = fields.optional_angle("pitch_deg", kQuarterTurn);
  camera.attitude_sigma = told_attitude_sigma(fields);
  return camera;
}

KnownView known_view(const Fields& fields) {
  return {told_agl_m(fields), fields.optional_angle("roll_deg", kQuarterTurn),
          fields.optional_angle("pitch_deg", kQuarterTurn), fields.optional_number(kTakeoffAgl, {}),
          told_attitude_sigma(fields)};
}

}  // namespace

const std::vector<std::string>& frame_scale_fields() {
  static const std::vector<std::string> kFields = joined({{"gsd_m", "exif"}, lens_fields(), view_fields()});
  return kFields;
}

std::optional<double> told_agl_m(const Fields& fields) { return fields.optional_number("agl_m", kHeightAboveGround); }

FrameScale parse_frame_scale(const Fields& fields, std::span<const std::uint8_t> picture) {
  const bool exif = fields.flag("exif");
  if (const auto gsd_m = fields.optional_number("gsd_m", kGsd)) {
    const std::vector<std::string> exif_field(exif ? 1 : 0, "exif");
    refuse(fields, joined({exif_field, lens_fields(), view_fields()}),
           "gsd_m, which means a frame seen from straight above");
    return {StraightDown{*gsd_m}};
  }
  if (!exif) return {told_camera(fields)};
  refuse(fields, lens_fields(), "exif=true, by which the file tells the lens");
  return scale_in_file(picture, known_view(fields));
}

FrameScale scale_in_file(std::span<const std::uint8_t> picture, const KnownView& known) {
  return {camera_of(drone_picture(read_picture_tags(picture)), known), true};
}

nlohmann::json to_json(const FrameCamera& camera) {
  nlohmann::json answer{{"agl_m", camera.agl_m},
                        {"roll_deg", camera.roll.value().degrees()},
                        {"pitch_deg", camera.pitch.value().degrees()}};
  if (camera.attitude_sigma) answer["attitude_sigma_deg"] = camera.attitude_sigma->degrees();
  if (camera.focal_px) answer["focal_px"] = *camera.focal_px;
  if (camera.principal_px) answer["principal_px"] = {camera.principal_px->x, camera.principal_px->y};
  if (!camera.distortion.empty()) answer["distortion"] = camera.distortion;
  return answer;
}

}  // namespace roadfix::api
