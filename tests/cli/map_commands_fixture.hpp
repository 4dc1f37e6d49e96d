// A small map, and `roadfix` run on it as a script does.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "tests/support/run_program.hpp"
#include "tests/tiles/store/map_fixture.hpp"

namespace roadfix::testing {

class MapCommands : public ::testing::Test {
 protected:
  MapCommands() {
    MapWriter writer(map, settings_37n());
    ingest(writer, {"a", 1, some_blocks(2)});
  }

  ProgramResult roadfix(const std::string& arguments) const { return run_program(folder.path(), arguments); }

  TemporaryFolder folder;
  const std::string map = folder / "m.gpkg";
};

}  // namespace roadfix::testing
