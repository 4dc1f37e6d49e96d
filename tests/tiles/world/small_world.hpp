// A world small enough to be rendered in a test, and its pictures read back.
#pragma once

#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "tests/support/temporary_folder.hpp"
#include "tiles/world/world.hpp"

namespace roadfix::world::testing {

inline WorldSettings small_settings(std::uint64_t seed = 1) {
  WorldSettings settings;
  settings.seed = seed;
  settings.width_m = 360.0;
  settings.height_m = 300.0;
  settings.gsd_m = 1.0;
  settings.collapsed_share = 0.2;
  settings.frames = 3;
  settings.footprint_m = 120.0;
  return settings;
}

/// Blue, green, red.
inline cv::Mat picture(const std::filesystem::path& path) { return cv::imread(path.string(), cv::IMREAD_COLOR); }

}  // namespace roadfix::world::testing
