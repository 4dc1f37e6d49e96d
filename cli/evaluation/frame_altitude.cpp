#include "cli/evaluation/frame_altitude.hpp"

#include <variant>

#include "core/units/error.hpp"

namespace roadfix::evaluation {

std::optional<Altitude> altitude_of(const FrameTruth& frame, const std::function<double(double above_sea_m)>& agl_of) {
  const auto* camera = std::get_if<FrameCamera>(&frame.view);
  if (camera == nullptr) return std::nullopt;
  if (!frame.alt_m) return Altitude{std::nullopt, camera->agl_m};
  return said_of(frame.file.string(), [&] { return Altitude{frame.alt_m, agl_of(*frame.alt_m)}; });
}

std::optional<Altitude> altitude_of(const FrameTruth& frame, const Prior& prior, const MapView& map) {
  return altitude_of(frame,
                     [&](double above_sea_m) { return required_agl_m(map, region_of(map, prior).box, above_sea_m); });
}

}  // namespace roadfix::evaluation
