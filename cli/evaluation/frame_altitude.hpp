// From how high a real frame was taken.
#pragma once

#include <functional>
#include <optional>

#include "cli/evaluation/frames_csv.hpp"
#include "core/locate/altitude.hpp"
#include "core/locate/map_view.hpp"
#include "core/locate/prior.hpp"

namespace roadfix::evaluation {

/// By the height above ground that is told of the frame, or what `agl_of` makes of that above the sea; nullopt where it
/// has no camera. Throws what `agl_of` does, as InvalidInput with the file's name.
std::optional<Altitude> altitude_of(const FrameTruth& frame, const std::function<double(double above_sea_m)>& agl_of);

/// As `fix` with that prior, by --agl or --alt: the same by required_agl_m().
std::optional<Altitude> altitude_of(const FrameTruth& frame, const Prior& prior, const MapView& map);

}  // namespace roadfix::evaluation
