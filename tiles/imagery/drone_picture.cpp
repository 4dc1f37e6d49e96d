#include "tiles/imagery/drone_picture.hpp"

#include <cpl_conv.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string_view>
#include <vector>

#include "core/units/error.hpp"

namespace roadfix {
namespace {

/// "+98.30", "(37) (45) (38.7)", "2023:02:09 11:05:10": the numbers, whatever stands between them.
std::vector<double> numbers_in(std::string_view text) {
  std::vector<double> numbers;
  const std::string copy(text);
  for (const char* at = copy.c_str(); *at != '\0';) {
    char* end = nullptr;
    const bool starts = std::string_view("+-.0123456789").find(*at) != std::string_view::npos;
    const double value = starts ? CPLStrtod(at, &end) : 0.0;
    if (starts && end != at && std::isfinite(value)) {
      numbers.push_back(value);
      at = end;
    } else {
      ++at;
    }
  }
  return numbers;
}

std::vector<double> numbers(const Tags& tags, const char* name) {
  const auto found = tags.find(name);
  return found == tags.end() ? std::vector<double>() : numbers_in(found->second);
}

/// Also of a fraction: "11485529/262144".
std::optional<double> number(const Tags& tags, const char* name) {
  const auto all = numbers(tags, name);
  if (all.size() == 2 && all[1] > 0.0 && tags.at(name).find('/') != std::string::npos) return all[0] / all[1];
  return all.size() == 1 ? std::optional(all.front()) : std::nullopt;
}

/// Of degrees.
std::optional<Angle> angle(const Tags& tags, const char* name) {
  const auto degrees = number(tags, name);
  return degrees ? std::optional(Angle::degrees(*degrees)) : std::nullopt;
}

std::optional<double> degrees_of(const Tags& exif, const char* name, const char* reference, char negative) {
  const auto parts = numbers(exif, name);
  const auto side = exif.find(reference);
  if (parts.size() != 3 || side == exif.end()) return std::nullopt;
  const double degrees = parts[0] + parts[1] / 60.0 + parts[2] / 3600.0;
  return side->second.starts_with(negative) ? -degrees : degrees;
}

/// Whether GDAL, which prints six digits of each number, cut an angle that is told in degrees alone.
bool is_cut(const Tags& exif, const char* name) {
  const auto parts = numbers(exif, name);
  return parts.size() == 3 && parts[0] != std::floor(parts[0]) && parts[1] == 0.0 && parts[2] == 0.0;
}

std::optional<LatLon> place_of(const PictureTags& tags) {
  constexpr const char* kLatitude = "EXIF_GPSLatitude";
  constexpr const char* kLongitude = "EXIF_GPSLongitude";
  auto lat = degrees_of(tags.exif, kLatitude, "EXIF_GPSLatitudeRef", 'S');
  auto lon = degrees_of(tags.exif, kLongitude, "EXIF_GPSLongitudeRef", 'W');
  if (!lat || !lon || is_cut(tags.exif, kLatitude) || is_cut(tags.exif, kLongitude)) {
    lat = number(tags.xmp, "GpsLatitude");
    lon = number(tags.xmp, "GpsLongitude");
  }
  const bool on_earth = lat && lon && std::abs(*lat) <= 90.0 && std::abs(*lon) <= 180.0;
  const bool no_fix = lat == 0.0 && lon == 0.0;
  return on_earth && !no_fix ? std::optional(LatLon{*lat, *lon}) : std::nullopt;
}

std::optional<double> time_of(const Tags& exif) {
  const auto parts = numbers(exif, "EXIF_DateTimeOriginal");
  const auto possible = [](double part) { return part >= 0.0 && part < 1e4; };
  if (parts.size() != 6 || !std::ranges::all_of(parts, possible)) return std::nullopt;
  if (parts[1] > 12.0 || parts[2] > 31.0) return std::nullopt;  // chrono would keep their last byte
  namespace chrono = std::chrono;
  const chrono::year_month_day date(chrono::year(static_cast<int>(parts[0])),
                                    chrono::month(static_cast<unsigned>(parts[1])),
                                    chrono::day(static_cast<unsigned>(parts[2])));
  if (!date.ok() || parts[3] >= 24.0 || parts[4] >= 60.0 || parts[5] > 60.0) return std::nullopt;
  const auto fraction = exif.find("EXIF_SubSecTime_Original");
  const auto after_point = fraction == exif.end() ? std::vector<double>() : numbers_in("0." + fraction->second);
  const auto days = static_cast<double>(chrono::sys_days(date).time_since_epoch().count());
  return days * 86400.0 + parts[3] * 3600.0 + parts[4] * 60.0 + parts[5] +
         (after_point.empty() ? 0.0 : after_point.front());
}

struct Attitude {
  Angle yaw;
  Angle pitch;
  Angle roll;
};

struct AttitudeTags {
  const char* yaw;
  const char* pitch;
  const char* roll;
};

std::optional<Attitude> attitude_of(const Tags& xmp, const AttitudeTags& tags) {
  const auto yaw = angle(xmp, tags.yaw);
  const auto pitch = angle(xmp, tags.pitch);
  const auto roll = angle(xmp, tags.roll);
  return yaw && pitch && roll ? std::optional(Attitude{*yaw, *pitch, *roll}) : std::nullopt;
}

/// The gimbal's angles turn a camera that looks ahead (NED, about z, y, x in this order); ours turn one that looks
/// down.
void set_gimbal(DronePicture& picture, const Attitude& gimbal) {
  const Angle up = gimbal.pitch + Angle::degrees(90.0);
  const Angle roll = gimbal.roll;
  picture.heading = (gimbal.yaw + Angle::radians(std::atan2(sin(roll), cos(up) * cos(roll)))).wrapped();
  picture.pitch = Angle::radians(std::asin(sin(up) * cos(roll)));
  picture.roll = Angle::radians(std::atan2(sin(up) * sin(roll), cos(up)));
}

void set_attitude(DronePicture& picture, const Tags& xmp) {
  constexpr AttitudeTags kDjiAndAutel{"GimbalYawDegree", "GimbalPitchDegree", "GimbalRollDegree"};
  constexpr AttitudeTags kParrot{"CameraYawDegree", "CameraPitchDegree", "CameraRollDegree"};
  for (const AttitudeTags& tags : {kDjiAndAutel, kParrot}) {
    if (const auto gimbal = attitude_of(xmp, tags)) return set_gimbal(picture, *gimbal);
  }
  if (const auto camera = attitude_of(xmp, {"Camera:Yaw", "Camera:Pitch", "Camera:Roll"})) {
    picture.heading = camera->yaw.wrapped();
    picture.pitch = camera->pitch;
    picture.roll = camera->roll;
  }
}

/// DewarpData: a date, then fx, fy, cx, cy (from the centre of the picture), k1, k2, p1, p2, k3.
bool set_dewarp_data(DronePicture& picture, const PictureTags& tags, double scale) {
  const auto found = tags.xmp.find("DewarpData");
  if (found == tags.xmp.end() || number(tags.xmp, "DewarpFlag") != 0.0) return false;
  const auto values = numbers_in(std::string_view(found->second).substr(found->second.find(';') + 1));
  if (values.size() != 9 || values[0] <= 0.0) return false;
  picture.focal_px = scale * values[0];
  picture.principal_px =
      cv::Point2d(0.5 * (tags.size.width - 1) + scale * values[2], 0.5 * (tags.size.height - 1) + scale * values[3]);
  picture.distortion.assign(values.begin() + 4, values.end());
  return true;
}

/// Pixels of the picture for each that the camera took; nullopt where the picture was cut, nobody knows where.
std::optional<double> scale_of(const PictureTags& tags) {
  const auto cols = number(tags.exif, "EXIF_PixelXDimension");
  const auto rows = number(tags.exif, "EXIF_PixelYDimension");
  if (!cols || !rows || *cols <= 0.0 || *rows <= 0.0) return 1.0;
  const double scale = tags.size.width / *cols;
  return std::abs(scale * *rows - tags.size.height) <= 2.0 ? std::optional(scale) : std::nullopt;
}

/// By the diagonal, as CIPA defines equivalents of 35 mm film.
std::optional<double> film_focal_px(const PictureTags& tags) {
  constexpr double kFilmDiagonalMm = 43.2666;  // of 36 x 24 mm
  const auto on_film = number(tags.exif, "EXIF_FocalLengthIn35mmFilm");
  if (!on_film || *on_film <= 0.0) return std::nullopt;
  return *on_film / kFilmDiagonalMm * std::hypot(tags.size.width, tags.size.height);
}

void set_calibrated_lens(DronePicture& picture, const PictureTags& tags, double scale) {
  if (set_dewarp_data(picture, tags, scale)) return;
  const auto focal = number(tags.xmp, "CalibratedFocalLength");
  if (focal && *focal > 0.0) picture.focal_px = scale * *focal;
}

/// Two focal lengths of one lens agree within this factor: film's is rounded to whole millimetres (2 % of 24 mm), some
/// makers take the width for the diagonal (4 %), and 16:9 cut out of 4:3 has a shorter diagonal (9 %), 16 % together.
/// A picture that was made smaller or cut by a program that rewrote or dropped its size is mostly off by more; which of
/// the two it was, and so which focal length is still right, no tag says.
constexpr double kSameLens = 1.2;

std::optional<LensDoubt> doubt_of(const PictureTags& tags, std::optional<double> calibrated_px,
                                  std::optional<double> film_px) {
  const double zoom = number(tags.exif, "EXIF_DigitalZoomRatio").value_or(0.0);
  if (zoom > 1.0) {
    // Some cameras enlarge the part to the full size and others do not, and EXIF does not tell which focal length
    // counts it already.
    return LensDoubt{"camera-zoomed", fmt::format("tells a digital zoom of {:g} (DigitalZoomRatio), and not which "
                                                  "focal length its pixels have with it",
                                                  zoom)};
  }
  if (calibrated_px && film_px && std::abs(std::log(*calibrated_px / *film_px)) > std::log(kSameLens)) {
    return LensDoubt{"camera-contradictory",
                     fmt::format("tells two focal lengths: {:.0f} pixels by its calibration (DewarpData or "
                                 "CalibratedFocalLength) and {:.0f} by FocalLengthIn35mmFilm, for {} x {} pixels; a "
                                 "program that made it smaller or cut it leaves such a file",
                                 *calibrated_px, *film_px, tags.size.width, tags.size.height)};
  }
  return std::nullopt;
}

void set_lens(DronePicture& picture, const PictureTags& tags) {
  const auto scale = scale_of(tags);
  if (!scale) return;
  set_calibrated_lens(picture, tags, *scale);
  const auto film_px = film_focal_px(tags);
  picture.doubt = doubt_of(tags, picture.focal_px, film_px);
  if (picture.doubt) {
    picture.focal_px.reset();
  } else if (!picture.focal_px) {
    picture.focal_px = film_px;
  }
}

[[noreturn]] void refuse(const char* lacks_and_advice) {
  throw InvalidInput("camera-not-in-file", fmt::format("the picture's file does not tell {}", lacks_and_advice));
}

/// 0 where nobody tells it.
double agl_of(const DronePicture& picture, const KnownView& known) {
  if (known.agl_m) return *known.agl_m;
  if (known.takeoff_agl_m) return required_takeoff_m(picture) + *known.takeoff_agl_m;
  return picture.agl_m.value_or(picture.takeoff_m.value_or(0.0));
}

}  // namespace

DronePicture drone_picture(const PictureTags& tags) {
  DronePicture picture;
  picture.place = place_of(tags);
  picture.time_s = time_of(tags.exif);
  picture.agl_m = number(tags.xmp, "Camera:AboveGroundAltitude");
  picture.takeoff_m = number(tags.xmp, "RelativeAltitude");
  set_attitude(picture, tags.xmp);
  set_lens(picture, tags);
  return picture;
}

double required_takeoff_m(const DronePicture& picture) {
  if (picture.takeoff_m) return *picture.takeoff_m;
  refuse(
      "its height above the take-off (RelativeAltitude): give its height above ground (--agl or agl_m) in place of how "
      "high the take-off lay");
}

FrameCamera camera_of(const DronePicture& picture, const KnownView& known) {
  if (picture.doubt) {
    throw InvalidInput(picture.doubt->code,
                       fmt::format("the picture's file {}: give its focal length in pixels and the height instead "
                                   "(--focal-px and --agl, or focal_px and agl_m), or use a picture as the drone "
                                   "stored it, without zoom",
                                   picture.doubt->what));
  }
  if (!picture.focal_px) {
    refuse(
        "its focal length (DewarpData, CalibratedFocalLength or FocalLengthIn35mmFilm, of a JPEG that was not cut): "
        "give its field of view or focal length and the height instead");
  }
  FrameCamera camera;
  camera.focal_px = picture.focal_px;
  camera.principal_px = picture.principal_px;
  camera.distortion = picture.distortion;
  camera.agl_m = agl_of(picture, known);
  if (camera.agl_m <= 0.0) refuse("a height above ground (RelativeAltitude or AboveGroundAltitude): give it besides");
  camera.roll = known.roll ? known.roll : picture.roll;
  camera.pitch = known.pitch ? known.pitch : picture.pitch;
  if (!camera.roll || !camera.pitch) {
    refuse(
        "where its camera looked (GimbalPitchDegree, CameraPitchDegree or Camera:Pitch, with yaw and roll): give both "
        "roll and pitch besides (--roll and --pitch, or roll_deg and pitch_deg), 0 and 0 if it looked straight down");
  }
  camera.attitude_sigma = known.attitude_sigma;
  return camera;
}

}  // namespace roadfix
