#include "cli/evaluation/frame_altitude.hpp"

#include <variant>

#include "core/units/error.hpp"

namespace roadfix::evaluation {

std::optional<Altitude> altitude_of(const FrameTruth& frame, const Prior& prior, const MapView& map) {
  const auto* camera = std::get_if<FrameCamera>(&frame.view);
  if (camera == nullptr) return std::nullopt;
  if (!frame.alt_m) return Altitude{std::nullopt, camera->agl_m};
  return said_of(frame.file.string(), [&] {
    return Altitude{frame.alt_m, required_agl_m(map, region_of(map, prior).box, *frame.alt_m)};
  });
}

}  // namespace roadfix::evaluation
