#include "tiles/world/road_truth.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/units/file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roadfix::world {
namespace {

/// Points on the rim come out a rounding beside it on some processors.
void expect_line(const Polyline& line, const Polyline& expected) {
  ASSERT_EQ(line.size(), expected.size());
  for (std::size_t i = 0; i < line.size(); ++i) EXPECT_LT(cv::norm(line[i] - expected[i]), 1e-9) << "point " << i;
}

TEST(RoadTruth, CutsLinesAtTheRimOfThePicture) {
  const auto parts = clipped({{-10, 5}, {5, 5}, {5, 30}, {8, 30}, {8, 5}, {9, 6}}, 20, 10);
  ASSERT_EQ(parts.size(), 2U);
  expect_line(parts[0], {{0, 5}, {5, 5}, {5, 10}});
  expect_line(parts[1], {{8, 10}, {8, 5}, {9, 6}});
}

TEST(RoadTruth, LeavesLinesWithinThePictureWhole) {
  Polyline line;
  for (int i = 0; i < 100; ++i) line.emplace_back(10.0 + 9.9 * std::sin(i), 5.0 + 4.9 * std::cos(1.7 * i));
  const auto parts = clipped(line, 20, 10);
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_EQ(parts[0], line);
}

TEST(RoadTruth, CutsLinesAtThe180thMeridian) {
  const UtmZone zone = UtmZone::containing({-17.0, 179.9999});
  const GridPoint meridian = zone.project({-17.0, 180.0});
  const roadfix::testing::TemporaryFolder folder;
  const std::string file = (folder / "roads.geojson").string();
  const Street street{.road_class = "residential", .line = {{0, 10}, {100, 10}, {100, 20}, {0, 20}}};
  write_road_truth(file, {street}, {zone, 1.0, 200, 100, {meridian.east_m - 50.0, meridian.north_m}});
  const nlohmann::json geometry = nlohmann::json::parse(read_named_file(file)).at("features").at(0).at("geometry");
  EXPECT_EQ(geometry.at("type"), "MultiLineString");
  const nlohmann::json& parts = geometry.at("coordinates");
  ASSERT_EQ(parts.size(), 3U);
  EXPECT_EQ(parts[0].back()[0], 180.0);
  EXPECT_EQ(parts[1].front()[0], -180.0);
  EXPECT_EQ(parts[1].back()[0], -180.0);
  EXPECT_EQ(parts[2].front()[0], 180.0);
  EXPECT_NEAR(zone.project({parts[0].back()[1], 180.0}).north_m, meridian.north_m - 10.0, 0.1);
  for (const nlohmann::json& part : parts) {
    for (const nlohmann::json& position : part) EXPECT_EQ(std::signbit(position[0].get<double>()), &part == &parts[1]);
  }
}

TEST(RoadTruth, LeavesOutLinesThatPassThePictureBy) {
  EXPECT_TRUE(clipped({{-5, -5}, {-5, 50}}, 20, 10).empty());
  EXPECT_TRUE(clipped({{-4, 5}, {4, -6}}, 20, 10).empty());
}

}  // namespace
}  // namespace roadfix::world
