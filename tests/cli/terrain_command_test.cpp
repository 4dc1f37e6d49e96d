// roadfix terrain as a person and a script meet it, and what the other commands then say of the map.
#include <gdal_priv.h>
#include <gmock/gmock.h>

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "tests/cli/map_commands_fixture.hpp"
#include "tests/tiles/sources/test_raster.hpp"

namespace roadfix {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::ProgramResult;

class TerrainCommand : public testing::MapCommands {
 protected:
  /// Around the map, 433,664 to 434,688 m east and 4,179,456 to 4,180,480 m north; heights rise from 500 m by 0.1 m for
  /// each of these pixels of 30 m to the south.
  std::string model(const std::string& name, int cols = 200, double west_m = 431'000.0) const {
    testing::RasterSpec spec{.width = cols, .height = 200, .type = GDT_Float32};
    spec.transform = std::array{west_m, 30.0, 0.0, 4'183'000.0, 0.0, -30.0};
    return testing::write_raster(folder / name, spec, [](int, int, int row) { return 500.0 + 0.1 * row; });
  }
  nlohmann::json info() const { return nlohmann::json::parse(roadfix("info --json " + map).out); }
};

TEST_F(TerrainCommand, GivesTheMapHeightsAndSaysWhich) {
  EXPECT_FALSE(info().contains("terrain"));
  const ProgramResult result =
      roadfix("terrain " + map + " " + model("dem.tif") + " --date 2021 --licence free --attribution 'DLR e.V.'");
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("terrain in cells of 32 m, 502 to 518 m above the sea, known on 100 % of the map"));
  EXPECT_THAT(result.err, Not(HasSubstr("note")));
  const nlohmann::json terrain = info()["terrain"];
  EXPECT_EQ(terrain["cell_m"], 32.0);
  EXPECT_NEAR(terrain["lowest_m"].get<double>(), 501.7, 1.0);
  EXPECT_NEAR(terrain["highest_m"].get<double>(), 518.0, 1.0);
  EXPECT_EQ(terrain["known_share"], 1.0);
  EXPECT_EQ(terrain["date"], "2021");
  EXPECT_EQ(terrain["licence"], "free");
  EXPECT_EQ(terrain["attribution"], "DLR e.V.");
  EXPECT_THAT(terrain["location"].get<std::string>(), HasSubstr("dem.tif"));
  EXPECT_THAT(roadfix("info " + map).out,
              AllOf(HasSubstr("terrain   cells of 32 m"), HasSubstr("DLR e.V."), HasSubstr("dem.tif")));
  EXPECT_EQ(roadfix("verify " + map).code, 0);
}

TEST_F(TerrainCommand, NotesWhatOfTheMapHasNoHeightsAndWhichModelsLieBeside) {
  const std::string there = model("half.tif", 105);
  const std::string beside = model("beside.tif", 10, 480'000.0);
  const ProgramResult result = roadfix("terrain --json " + map + " " + there + " " + beside);
  EXPECT_EQ(result.code, 0) << result.err;
  const nlohmann::json answer = nlohmann::json::parse(result.out);
  EXPECT_NEAR(answer["terrain"]["known_share"].get<double>(), 0.47, 0.03);
  ASSERT_EQ(answer["notes"].size(), 2U);
  EXPECT_THAT(result.err, AllOf(HasSubstr("note: " + beside + " knows no height"), HasSubstr("note: on 5")));
}

TEST_F(TerrainCommand, ReplacesHeightsAndTakesThemOut) {
  ASSERT_EQ(roadfix("terrain " + map + " " + model("half.tif", 105)).code, 0);
  ASSERT_EQ(roadfix("terrain " + map + " " + model("dem.tif")).code, 0);
  EXPECT_EQ(info()["terrain"]["known_share"], 1.0);
  EXPECT_THAT(roadfix("terrain " + map + " --remove").out, HasSubstr("its terrain is removed"));
  EXPECT_FALSE(info().contains("terrain"));
  const ProgramResult again = roadfix("terrain " + map + " --remove");
  EXPECT_EQ(again.code, 1);
  EXPECT_THAT(again.err, HasSubstr("[terrain-not-found]"));
}

TEST_F(TerrainCommand, LeavesTheMapAsItWasWhereItIsRefused) {
  ASSERT_EQ(roadfix("terrain " + map + " " + model("dem.tif")).code, 0);
  const nlohmann::json before = info();
  for (const auto& [models, code] : {std::pair{map, "elevation-not-heights"},
                                     {std::string("no.tif"), "file-not-found"},
                                     {model("far.tif", 10, 480'000.0), "elevation-beyond-map"}}) {
    const ProgramResult result = roadfix("terrain " + map + " " + models);
    EXPECT_EQ(result.code, 1);
    EXPECT_THAT(result.err, HasSubstr("[" + std::string(code) + "]"));
  }
  {
    const MapWriter writer(map, testing::settings_37n());
    EXPECT_THAT(roadfix("terrain " + map + " dem.tif").err, HasSubstr("[map-in-use]"));
  }
  EXPECT_EQ(info(), before);
}

TEST_F(TerrainCommand, WantsModelsOrToRemoveAndAMapWithGround) {
  EXPECT_EQ(roadfix("terrain " + map).code, 2);
  EXPECT_EQ(roadfix("terrain " + map + " dem.tif --remove").code, 2);
  EXPECT_EQ(roadfix("terrain " + map + " --remove --licence free").code, 2);
  EXPECT_EQ(roadfix("terrain " + map + " dem.tif --date yesterday").code, 2);
  const std::string empty = folder / "empty.gpkg";
  { const MapWriter writer(empty, testing::settings_37n()); }
  EXPECT_THAT(roadfix("terrain " + empty + " " + model("dem.tif")).err, HasSubstr("[map-has-no-cells]"));
}

TEST_F(TerrainCommand, OfWhichATileIsDamagedIsFoundByVerifyAndMendedByRepairOrByItself) {
  const auto damage = [&] {
    testing::open_sqlite(map).execute("UPDATE roadfix_terrain SET tile_data = x'00' WHERE id = 1");
    EXPECT_THAT(roadfix("info " + map).err, HasSubstr("[terrain-corrupt]"));
    const ProgramResult found = roadfix("verify --json " + map);
    EXPECT_EQ(found.code, 1);
    EXPECT_EQ(nlohmann::json::parse(found.out)["problems"][0]["code"], "terrain-damaged");
  };
  const std::string write = "terrain " + map + " " + model("dem.tif");
  ASSERT_EQ(roadfix(write).code, 0);
  damage();
  const ProgramResult repair = roadfix("verify --repair " + map);
  EXPECT_EQ(repair.code, 0) << repair.err;
  EXPECT_THAT(repair.err, AllOf(HasSubstr("heights of tile column"), HasSubstr("roadfix terrain")));
  ASSERT_EQ(roadfix(write).code, 0);
  damage();
  EXPECT_EQ(roadfix(write).code, 0);
  EXPECT_EQ(roadfix("verify " + map).code, 0);
}

}  // namespace
}  // namespace roadfix
