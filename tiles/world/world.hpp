// A rendered world: a town or open country before and after an earthquake with the truth about its roads and about
// frames of it. It gives demo, tests and training a ground truth; it is no substitute for real imagery.
#pragma once

#include <cstdint>
#include <filesystem>
#include <stop_token>

#include "core/units/planar.hpp"
#include "core/units/progress.hpp"
#include "tiles/world/plan.hpp"
#include "tiles/world/settings.hpp"

namespace roadfix::world {

/// What was written, for world.json and for people.
struct WorldReport {
  Placement placement;
  int road_lines = 0;
  double road_km = 0.0;
  int blocks = 0;
  int buildings = 0;
  int collapsed = 0;
  int trees = 0;
  int frames = 0;
};

/// Pixels on a side of what progress counts.
inline constexpr int kTilePx = 1024;

/// Writes pre.tif, post.tif, roads.geojson, frames/, bench.json where there are frames, and at last world.json into the
/// folder, which is made where it is missing. What an earlier world left there goes first, so that a folder without
/// world.json holds an unfinished one and never parts of two. The same settings give the same bytes. Throws
/// InvalidInput for settings that cannot be met, IoFailure, Interrupted.
WorldReport render_world(const WorldSettings& settings, const std::filesystem::path& folder, const OnProgress& progress,
                         const std::stop_token& stop);

}  // namespace roadfix::world
