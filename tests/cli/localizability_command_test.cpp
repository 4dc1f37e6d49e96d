// roadfix localizability as a script meets it: of a map, and along a route.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/cli/localize_commands_fixture.hpp"

namespace roadfix {
namespace {

using ::testing::HasSubstr;
using testing::LocalizeCommands;
using testing::ProgramResult;

using LocalizabilityCommand = LocalizeCommands;

TEST_F(LocalizabilityCommand, SaysHowMuchOfTheGroundGivesAFix) {
  const std::string ask = "localizability " + map.string() + " --footprint-m 400";
  const ProgramResult result = roadfix(ask + " --json");
  ASSERT_EQ(result.code, 0) << result.err;
  const auto answer = nlohmann::json::parse(result.out);
  EXPECT_EQ(answer["map"]["name"], "town");
  EXPECT_EQ(answer["places"], 6);
  EXPECT_NEAR(answer["ground_km2"].get<double>(), 0.9, 1e-6);
  EXPECT_GT(answer["distinct"], 0.5);
  EXPECT_NEAR(answer["distinct"].get<double>() + answer["sparse"].get<double>() + answer["bare"].get<double>(), 1.0,
              1e-9);
  const std::string few = roadfix(ask + " --places 2").out;
  EXPECT_THAT(few, HasSubstr("town: 0.9 km2 of ground, for frames that show 400 m of it; asked at places: 2, too few"));
  EXPECT_EQ(roadfix("localizability " + map.string()).code, 2) << "of which footprint?";
}

TEST_F(LocalizabilityCommand, OfARouteSaysWhereAFlightHasFixesAndHowLongItGoesWithout) {
  // The town, 1000 x 900 m, from west to east, and as far again beyond the map.
  const auto waypoint = [&](int number, double east_m) {
    const LatLon at = zone.unproject({600'200.0 + east_m, 6'399'450.0});
    return fmt::format("{} 0 3 16 0 0 0 0 {:.9f} {:.9f} 300 1\n", number, at.lat_deg, at.lon_deg);
  };
  const std::filesystem::path mission = folder / "mission.waypoints";
  std::ofstream(mission) << "QGC WPL 110\n" << waypoint(0, 0.0) << waypoint(1, 2000.0) << "2 0 3 177 1 1 0 0 0 0 0 1\n";
  const std::string ask = "localizability " + map.string() + " --footprint-m 400 --route " + mission.string();

  const ProgramResult told = roadfix(ask);
  ASSERT_EQ(told.code, 0) << told.err;
  EXPECT_THAT(told.out,
              HasSubstr("mission.waypoints: 2.0 km, for frames that show 400 m of ground; asked every 200 m"));
  EXPECT_THAT(told.out, HasSubstr("longest without a fix: 1.0 km, from km 1.0"));

  const std::filesystem::path pieces = folder / "pieces.geojson";
  const ProgramResult result = roadfix(ask + " --every-m 500 --json --geojson " + pieces.string());
  ASSERT_EQ(result.code, 0) << result.err;
  const auto answer = nlohmann::json::parse(result.out);
  EXPECT_EQ(answer["map"]["name"], "town");
  EXPECT_EQ(answer["places"], 4);
  EXPECT_NEAR(answer["length_m"].get<double>(), 2000.0, 0.1);
  EXPECT_EQ(answer["distinct"], 0.5);
  EXPECT_EQ(answer["unknown"], 0.5);
  EXPECT_THAT(answer["left_out"].at(0).get<std::string>(), HasSubstr("line 4, a jump"));
  EXPECT_EQ(answer["first_fix_m"], 0.0);
  EXPECT_NEAR(answer["longest_without_fix"]["from_m"].get<double>(), 1000.0, 0.1);
  const auto features = nlohmann::json::parse(std::ifstream(pieces))["features"];
  ASSERT_EQ(features.size(), 4U);
  EXPECT_EQ(features[0]["geometry"]["type"], "LineString");
  EXPECT_EQ(features[1]["properties"]["place"], "distinct");
  EXPECT_EQ(features[2]["properties"]["place"], "unknown");

  EXPECT_THAT(roadfix(ask + " --geojson " + mission.string()).err, HasSubstr("[target-is-source]"));
  EXPECT_EQ(roadfix("localizability " + map.string() + " --footprint-m 400 --every-m 100").code, 2)
      << "of which route?";
}

/// Through the town, 1000 m from west to east, and down from 300 m above its home.
class LocalizabilityByHeight : public LocalizeCommands {
 protected:
  std::filesystem::path mission(int frame, double end_m) const {
    const auto waypoint = [&](int number, double east_m, double height_m) {
      const LatLon at = zone.unproject({600'200.0 + east_m, 6'399'450.0});
      return fmt::format("{} 0 {} 16 0 0 0 0 {:.9f} {:.9f} {} 1\n", number, frame, at.lat_deg, at.lon_deg, height_m);
    };
    std::filesystem::path file = folder / "climb.waypoints";
    std::ofstream(file) << "QGC WPL 110\n" << waypoint(0, 0.0, 300.0) << waypoint(1, 1000.0, end_m);
    return file;
  }
  /// Frames are as wide as high, and show 4/3 m of ground for each metre above it.
  ProgramResult ask(const std::filesystem::path& route, const std::string& more = "") const {
    return roadfix("localizability " + map.string() + " --fov 67.380135 --aspect 1 --route " + route.string() + more);
  }
};

TEST_F(LocalizabilityByHeight, LooksAtAsMuchGroundAsACameraShowsFromThere) {
  const std::filesystem::path pieces = folder / "pieces.geojson";
  const ProgramResult result = ask(mission(3, 100.0), " --every-m 500 --json --geojson " + pieces.string());
  ASSERT_EQ(result.code, 0) << result.err;
  const auto answer = nlohmann::json::parse(result.out);
  EXPECT_NEAR(answer["fov_deg"].get<double>(), 67.380135, 1e-6);
  EXPECT_EQ(answer["aspect"], 1.0);
  EXPECT_FALSE(answer.contains("footprint_m"));
  EXPECT_NEAR(answer["agl_range_m"][0].get<double>(), 150.0, 0.01);
  EXPECT_NEAR(answer["agl_range_m"][1].get<double>(), 250.0, 0.01);
  EXPECT_NEAR(answer["footprint_range_m"][1].get<double>(), 333.33, 0.01);
  const auto features = nlohmann::json::parse(std::ifstream(pieces))["features"];
  ASSERT_EQ(features.size(), 2U);
  EXPECT_NEAR(features[0]["properties"]["footprint_m"].get<double>(), 333.33, 0.01);
  EXPECT_NEAR(features[1]["properties"]["footprint_m"].get<double>(), 200.0, 0.01);
  EXPECT_NEAR(features[1]["properties"]["agl_m"].get<double>(), 150.0, 0.01);

  const std::string told = ask(mission(3, 100.0), " --every-m 500").out;
  EXPECT_THAT(told,
              HasSubstr("1.0 km, 150 to 250 m above ground, of which frames show 200 to 333 m; asked every 500 m"));
  EXPECT_THAT(told, ::testing::Not(HasSubstr("too low")));
  EXPECT_THAT(ask(mission(3, -290.0), " --every-m 500").out, HasSubstr("0.5 km below the ground, first at km 0.5 ("));
  EXPECT_THAT(ask(mission(3, -90.0), " --every-m 500").out,
              HasSubstr("0.5 km too low to show 20 m of ground, first at km 0.5 ("));
}

TEST_F(LocalizabilityByHeight, TakesHeightsThatTheRouteAndTheMapTell) {
  EXPECT_THAT(ask(mission(0, 300.0)).err, ::testing::AllOf(HasSubstr("line 3"), HasSubstr("[terrain-missing]")));
  EXPECT_THAT(ask(mission(2, 300.0)).err, ::testing::AllOf(HasSubstr("line 3"), HasSubstr("[heights-missing]")));
  EXPECT_THAT(ask(mission(2, 300.0), " --agl 300 --every-m 1000").out, HasSubstr("150 to 150 m above ground"))
      << "from the home";
  EXPECT_EQ(ask(mission(3, 300.0), " --footprint-m 400").code, 2) << "or by height";
  EXPECT_EQ(roadfix("localizability " + map.string() + " --fov 70").code, 2) << "of which route?";
}

}  // namespace
}  // namespace roadfix
