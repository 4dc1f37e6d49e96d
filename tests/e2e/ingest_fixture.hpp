// roadfix ingest as a command, and a picture for it.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/e2e/child_process.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/tiles/sources/test_raster.hpp"

namespace roadfix::testing {

class IngestCommand : public ::testing::Test {
 protected:
  ChildResult ingest(std::vector<std::string> arguments, std::chrono::microseconds kill_after = {},
                     int signal = 9) const {
    arguments.insert(arguments.begin(), "ingest");
    return run_child(ROADFIX_PROGRAM, arguments, folder.path(), kill_after, signal);
  }
  std::string map(const std::string& name) const { return folder / name; }

  /// A picture of noise with a grid of bright streets.
  std::string picture(int side, double gsd_m) const {
    RasterSpec spec{.width = side, .height = side, .bands = 3, .creation = {"TILED=YES"}};
    spec.transform = {400000.0, gsd_m, 0.0, 4200000.0, 0.0, -gsd_m};
    return write_raster(folder / "city.tif", spec, [](int, int col, int row) {
      const std::uint32_t noise =
          (static_cast<std::uint32_t>(col) * 2654435761U ^ static_cast<std::uint32_t>(row) * 40503U) >> 20U;
      return (col % 150 < 12 || row % 190 < 12) ? 180.0 + noise % 8U : 60.0 + noise % 64U;
    });
  }

  TemporaryFolder folder;
};

}  // namespace roadfix::testing
