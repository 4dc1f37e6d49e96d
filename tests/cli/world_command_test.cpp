// roadfix world as a script meets it.
#include <gmock/gmock.h>

#include <fstream>
#include <string>

#include "tests/support/run_program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roadfix {
namespace {

using ::testing::HasSubstr;
using testing::ProgramResult;
using testing::run_program;

TEST(WorldCommand, LeavesAManifestThatBenchRunsAsItIs) {
  const testing::TemporaryFolder folder;
  const std::string town = (folder / "town").string();
  const ProgramResult world = run_program(folder.path(), "world " + town + " --size-km 0.6x0.6 --frames 1");
  ASSERT_EQ(world.code, 0) << world.err;
  const ProgramResult bench = run_program(
      folder.path(), "bench " + town + "/bench.json --detector tree --map-cache " + (folder / "cache").string());
  EXPECT_EQ(bench.code, 0) << bench.err;
  for (const char* method : {"roads   before", "sift    before", "orb     before"}) {
    EXPECT_THAT(bench.out, HasSubstr(method));
  }
}

TEST(WorldCommand, ItsFolderHasAName) {
  const testing::TemporaryFolder folder;
  EXPECT_THAT(run_program(folder.path(), "world -").err, HasSubstr("[target-is-dash]"));
}

TEST(WorldCommand, KeepsTheRoadsThatItIsGiven) {
  const testing::TemporaryFolder folder;
  const std::string roads = (folder / "roads.geojson").string();
  std::ofstream(roads) << "mine";
  const ProgramResult world = run_program(folder.path(), "world " + folder.path().string() + " --roads " + roads);
  EXPECT_THAT(world.err, HasSubstr("target-is-source"));
  EXPECT_EQ(testing::text_of(roads), "mine");

  const ProgramResult of_folder =
      run_program(folder.path(), "world " + folder.path().string() + " --roads " + folder.path().string());
  EXPECT_THAT(of_folder.err, HasSubstr("target-is-source"));
  EXPECT_EQ(testing::text_of(roads), "mine");
}

TEST(WorldCommand, RendersALandThatItKnowsOnly) {
  const testing::TemporaryFolder folder;
  const std::string place = (folder / "place").string();
  const ProgramResult sea = run_program(folder.path(), "world " + place + " --land sea");
  EXPECT_NE(sea.code, 0);
  EXPECT_THAT(sea.err, HasSubstr("--land"));
  const ProgramResult country =
      run_program(folder.path(), "world " + place + " --land country --size-km 0.3x0.3 --gsd 1 --frames 0");
  EXPECT_EQ(country.code, 0) << country.err;
  EXPECT_THAT(country.out, HasSubstr("km of roads"));
}

}  // namespace
}  // namespace roadfix
