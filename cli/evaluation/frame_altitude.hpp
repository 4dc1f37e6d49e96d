// From how high a real frame was taken.
#pragma once

#include <optional>

#include "cli/evaluation/frames_csv.hpp"
#include "core/locate/altitude.hpp"
#include "core/locate/map_view.hpp"
#include "core/locate/prior.hpp"

namespace roadfix::evaluation {

/// As `fix` with that prior, by --agl or --alt; nullopt where the frame has no camera. Throws what required_agl_m()
/// does, as InvalidInput with the file's name.
std::optional<Altitude> altitude_of(const FrameTruth& frame, const Prior& prior, const MapView& map);

}  // namespace roadfix::evaluation
