// A world small enough to be rendered in a test, and its pictures read back.
#pragma once

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <string>

#include "core/units/error.hpp"
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

inline std::string bytes_of(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

inline WorldReport render(const WorldSettings& settings, const std::filesystem::path& folder) {
  return render_world(settings, folder, {}, {});
}

/// The code of the error that rendering ends with; empty when it does not.
inline std::string failure(const WorldSettings& settings, const std::filesystem::path& folder) {
  try {
    render(settings, folder);
  } catch (const Error& error) {
    return error.code();
  }
  return {};
}

}  // namespace roadfix::world::testing
