#include "server/api/altitude_request.hpp"

#include "core/units/error.hpp"
#include "server/api/feature_request.hpp"
#include "server/api/frame_scale.hpp"
#include "server/api/position_answer.hpp"
#include "server/http/errors.hpp"

namespace roadfix::api {
namespace {

constexpr const char* kTakeoffAlt = "takeoff_alt_m";

[[noreturn]] void refuse_takeoff(const char* why) { throw http::InvalidField("bad-parameter", kTakeoffAlt, why); }

std::optional<Altitude> take_takeoff(Content& content, double takeoff_alt_m, const AglOf& agl_of) {
  Fields& fields = content.fields;
  if (!is_frame(fields) || !fields.flag("exif")) {
    refuse_takeoff(
        "'takeoff_alt_m' goes with exif=true, a frame whose file tells its height above the take-off: give alt_m for "
        "one of another camera, or leave it out");
  }
  if (fields.has("agl_m")) {
    refuse_takeoff("'takeoff_alt_m' cannot be combined with agl_m, by which the height above ground is told already");
  }
  if (content.image.empty()) return std::nullopt;
  const AboveTakeoff taken = above_takeoff(content.image, takeoff_alt_m, agl_of);
  fields.set_number(kTakeoffAgl, taken.takeoff_agl_m);
  return taken.altitude;
}

/// nullopt where the map does not know the heights of its ground: alt_m is for the autopilot alone then.
std::optional<double> agl_of_photo(double above_sea_m, const AglOf& agl_of) {
  try {
    return agl_of(above_sea_m);
  } catch (const InvalidInput& error) {
    if (error.code() != "terrain-missing") throw;
    return std::nullopt;
  }
}

}  // namespace

const std::vector<std::string>& altitude_fields() {
  static const std::vector<std::string> kFields{kTakeoffAlt};
  return kFields;
}

std::optional<Altitude> take_altitude(Content& content, const AglOf& agl_of) {
  Fields& fields = content.fields;
  if (const auto alt_m = fields.optional_number(kTakeoffAlt, kAltitude)) return take_takeoff(content, *alt_m, agl_of);
  if (!is_frame(fields) || fields.has("gsd_m")) return std::nullopt;
  if (const auto agl_m = told_agl_m(fields)) return Altitude{std::nullopt, *agl_m};
  const auto above_sea_m = told_altitude_m(fields);
  if (!above_sea_m) return std::nullopt;
  const auto agl_m = fields.flag("exif") ? agl_of_photo(*above_sea_m, agl_of) : agl_of(*above_sea_m);
  if (!agl_m) return std::nullopt;
  fields.set_number("agl_m", *agl_m);
  return Altitude{above_sea_m, *agl_m};
}

AboveTakeoff above_takeoff(std::span<const std::uint8_t> photo, double takeoff_alt_m, const AglOf& agl_of) {
  const double takeoff_m = required_takeoff_m(drone_picture(read_picture_tags(photo)));
  const double above_sea_m = takeoff_alt_m + takeoff_m;
  const double agl_m = agl_of(above_sea_m);
  return {{above_sea_m, agl_m}, agl_m - takeoff_m};
}

std::optional<Altitude> altitude_in_file(const Features& features) {
  if (!features.camera_in_file) return std::nullopt;
  return Altitude{std::nullopt, features.camera_in_file->agl_m};
}

}  // namespace roadfix::api
