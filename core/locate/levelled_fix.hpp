// A fix over ground that is not level, where the map knows its heights: what its relief displaces in a frame follows
// from where the vehicle is.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/grid/combine.hpp"
#include "core/locate/altitude.hpp"
#include "core/locate/fix.hpp"

namespace roadfix {

/// What frames show if the vehicle took the first of them at `place`, and the others at their offsets from there: each
/// in the size that its height above the ground gives it, and levelled (core/grid/relief.hpp), in cells of one size.
/// The map has heights; `frames` is not empty, and all of it was made for `altitude`, raised by each frame's higher_m.
std::vector<PlacedFeatures> levelled_frames(const MapView& map, std::span<const PlacedFeatures> frames,
                                            const Altitude& altitude, const GridPose& place);

/// locate_from(), and where the relief around the best place displaces what was seen, once more with that levelled. The
/// second search has to find that place again; if not, it is no likely one ("terrain-contradicts"), nor where the time
/// is over before ("search-time-limit"). Nothing is levelled where `altitude` is nullopt.
Fix locate_levelled(const std::optional<Altitude>& altitude, const MapView& map, const FeatureMap& features,
                    const Prior& prior, const FixOptions& options);

}  // namespace roadfix
