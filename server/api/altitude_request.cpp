#include "server/api/altitude_request.hpp"

#include "server/api/feature_request.hpp"
#include "server/api/frame_scale.hpp"
#include "server/api/position_answer.hpp"

namespace roadfix::api {

std::optional<Altitude> take_altitude(Fields& fields, const AglOf& agl_of) {
  if (!is_frame(fields) || fields.flag("exif") || fields.has("gsd_m")) return std::nullopt;
  if (const auto agl_m = told_agl_m(fields)) return Altitude{std::nullopt, *agl_m};
  const auto above_sea_m = told_altitude_m(fields);
  if (!above_sea_m) return std::nullopt;
  const double agl_m = agl_of(*above_sea_m);
  fields.set_number("agl_m", agl_m);
  return Altitude{above_sea_m, agl_m};
}

}  // namespace roadfix::api
