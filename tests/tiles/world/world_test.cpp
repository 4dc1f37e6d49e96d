#include "tiles/world/world.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <opencv2/imgproc.hpp>

#include "tests/tiles/world/small_world.hpp"
#include "tiles/roads/road_lines.hpp"
#include "tiles/sources/gdal_session.hpp"

namespace roadfix::world {
namespace {

using roadfix::testing::TemporaryFolder;
using testing::bytes_of;
using testing::failure;
using testing::picture;
using testing::render;
using testing::small_settings;

/// Where the truth says that road is: 255, one pixel of the picture a pixel.
cv::Mat1b road_mask(const std::filesystem::path& truth, const Placement& placement, double shrink_m) {
  RoadRules rules;
  rules.set_width_attribute("width_m");
  const RoadNetwork network = read_road_network({truth.string()}, {}, rules, placement.zone);
  cv::Mat1b mask(placement.rows, placement.cols, std::uint8_t{0});
  for (const RoadLine& line : network.lines) {
    std::vector<cv::Point> points;
    for (std::size_t i = 0; i < line.points; ++i) {
      const GridPoint p = network.points[line.first_point + i];
      points.emplace_back(cvRound((p.east_m - placement.north_west.east_m) / placement.gsd_m - 0.5),
                          cvRound((placement.north_west.north_m - p.north_m) / placement.gsd_m - 0.5));
    }
    const double width_px = (2.0 * line.half_width_m - shrink_m) / placement.gsd_m;
    cv::polylines(mask, points, false, 255, std::max(1, cvRound(width_px)));
  }
  return mask;
}

/// Median of the brightness' slope under the mask, noise aside: how busy the picture is there.
double busyness(const cv::Mat& bgr, const cv::Mat1b& mask) {
  cv::Mat grey;
  cv::cvtColor(bgr, grey, cv::COLOR_BGR2GRAY);
  cv::GaussianBlur(grey, grey, {}, 1.5);
  cv::Mat1f right;
  cv::Mat1f down;
  cv::Sobel(grey, right, CV_32F, 1, 0);
  cv::Sobel(grey, down, CV_32F, 0, 1);
  std::vector<float> values;
  for (int row = 0; row < mask.rows; ++row) {
    for (int col = 0; col < mask.cols; ++col) {
      if (mask(row, col) != 0) values.push_back(std::hypot(right(row, col), down(row, col)));
    }
  }
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return static_cast<double>(*middle);
}

TEST(World, ComesOutTheSameToTheByteForTheSameSeedOnly) {
  const TemporaryFolder folder;
  render(small_settings(7), folder / "a");
  render(small_settings(7), folder / "b");
  render(small_settings(8), folder / "c");
  for (const char* name : {"pre.tif", "post.tif", "roads.geojson", "world.json", "frames/frames.csv",
                           "frames/frame_01.png", "frames/frame_03.png"}) {
    const std::string a = bytes_of(folder / "a" / name);
    EXPECT_FALSE(a.empty()) << name;
    EXPECT_EQ(a, bytes_of(folder / "b" / name)) << name;
    EXPECT_NE(a, bytes_of(folder / "c" / name)) << name;
  }
}

TEST(World, OnVariedDaysIsTheSameTownUnderAnotherSun) {
  const TemporaryFolder folder;
  WorldSettings settings = small_settings(7);
  render(settings, folder / "usual");
  settings.varied = true;
  render(settings, folder / "varied");
  render(settings, folder / "again");
  EXPECT_EQ(bytes_of(folder / "usual" / "roads.geojson"), bytes_of(folder / "varied" / "roads.geojson"));
  for (const char* name : {"pre.tif", "post.tif"}) {
    EXPECT_NE(bytes_of(folder / "usual" / name), bytes_of(folder / "varied" / name)) << name;
    EXPECT_EQ(bytes_of(folder / "varied" / name), bytes_of(folder / "again" / name)) << name;
  }
}

TEST(World, OfOpenCountryComesWithTheTruthAboutItsRoads) {
  const TemporaryFolder folder;
  WorldSettings settings = small_settings(7);
  settings.land = Land::kCountry;
  settings.varied = true;
  const WorldReport report = render(settings, folder / "a");
  render(settings, folder / "b");
  EXPECT_GT(report.road_km, 0.2);
  for (const char* name : {"pre.tif", "post.tif", "roads.geojson", "world.json", "frames/frame_01.png"}) {
    EXPECT_FALSE(bytes_of(folder / "a" / name).empty()) << name;
    EXPECT_EQ(bytes_of(folder / "a" / name), bytes_of(folder / "b" / name)) << name;
  }
  const std::string truth = bytes_of(folder / "a" / "roads.geojson");
  EXPECT_THAT(truth, ::testing::HasSubstr(R"("highway":"track","width_m":)"));
  EXPECT_THAT(truth, ::testing::HasSubstr(R"("surface":")"));
  EXPECT_THAT(bytes_of(folder / "a" / "world.json"), ::testing::HasSubstr(R"("land": "country")"));
}

TEST(World, LiesWhereItWasAskedForInTheZoneOfItsCentre) {
  const TemporaryFolder folder;
  WorldSettings settings = small_settings();
  settings.centre = LatLon{-33.45, -70.66};
  const WorldReport report = render(settings, folder.path());
  EXPECT_EQ(report.placement.zone.epsg(), 32719);
  for (const char* name : {"pre.tif", "post.tif"}) {
    const DatasetPtr dataset = open_dataset(folder / name, GDAL_OF_RASTER);
    EXPECT_EQ(crs_name(*dataset->GetSpatialRef()), "EPSG:32719");
    ASSERT_EQ(dataset->GetRasterXSize(), 360);
    ASSERT_EQ(dataset->GetRasterYSize(), 300);
    EXPECT_EQ(dataset->GetRasterCount(), 3);
    std::array<double, 6> transform{};
    ASSERT_EQ(dataset->GetGeoTransform(transform.data()), CE_None);
    EXPECT_EQ(transform[1], 1.0);
    EXPECT_EQ(transform[5], -1.0);
    const GridPoint centre = report.placement.zone.project(*settings.centre);
    EXPECT_NEAR(transform[0] + 180.0, centre.east_m, 0.51);
    EXPECT_NEAR(transform[3] - 150.0, centre.north_m, 0.51);
  }
}

TEST(World, ShowsRoadsWhereItsTruthSaysThatTheyAre) {
  const TemporaryFolder folder;
  WorldSettings settings = small_settings(3);
  settings.gsd_m = 0.5;
  const WorldReport report = render(settings, folder.path());
  const cv::Mat before = picture(folder / "pre.tif");
  const cv::Mat1b middle = road_mask(folder / "roads.geojson", report.placement, 4.0);
  const cv::Mat1b road = road_mask(folder / "roads.geojson", report.placement, 0.0);
  const double share = cv::countNonZero(road) / static_cast<double>(road.total());
  cv::Mat1b elsewhere;
  cv::bitwise_not(road, elsewhere);
  EXPECT_GT(share, 0.06);
  EXPECT_LT(share, 0.35);
  EXPECT_LT(busyness(before, middle), 0.6 * busyness(before, elsewhere));
}

TEST(World, IsAnotherPictureAfterTheEarthquakeOnRoadsToo) {
  const TemporaryFolder folder;
  const WorldReport report = render(small_settings(3), folder.path());
  EXPECT_EQ(report.collapsed, std::lround(0.2 * report.buildings));
  cv::Mat change;
  cv::absdiff(picture(folder / "pre.tif"), picture(folder / "post.tif"), change);
  const cv::Mat1b road = road_mask(folder / "roads.geojson", report.placement, 2.0);
  EXPECT_GT(cv::mean(change)[0], 12.0);
  EXPECT_GT(cv::mean(change, road)[0], 6.0);
}

TEST(World, CanBeDrawnAroundRealRoads) {
  const TemporaryFolder folder;
  const auto roads = folder / "roads.geojson";
  std::ofstream(roads) << R"({"type":"FeatureCollection","features":[
    {"type":"Feature","properties":{"highway":"primary","width":"14"},
     "geometry":{"type":"LineString","coordinates":[[11.96,57.70],[11.97,57.70]]}},
    {"type":"Feature","properties":{"highway":"residential"},
     "geometry":{"type":"LineString","coordinates":[[11.965,57.69],[11.965,57.71]]}},
    {"type":"Feature","properties":{"highway":"footway"},
     "geometry":{"type":"LineString","coordinates":[[11.96,57.701],[11.97,57.701]]}}]})";
  WorldSettings settings = small_settings();
  settings.roads = roads;
  const WorldReport report = render(settings, folder / "world");
  EXPECT_EQ(report.placement.zone.epsg(), 32632);
  EXPECT_EQ(report.road_lines, 2);
  EXPECT_NEAR(report.road_km, 0.66, 0.02);
  EXPECT_THAT(bytes_of(folder / "world" / "roads.geojson"), ::testing::HasSubstr(R"("highway":"primary")"));

  settings.roads = folder / "roads";
  std::filesystem::create_directory(settings.roads);
  std::filesystem::copy(roads, folder / "roads" / "first.geojson");
  std::ofstream(folder / "roads" / "second.geojson") << R"({"type":"FeatureCollection","features":[
    {"type":"Feature","properties":{"highway":"residential"},
     "geometry":{"type":"LineString","coordinates":[[11.966,57.69],[11.966,57.71]]}}]})";
  EXPECT_EQ(render(settings, folder / "several").road_lines, 3) << "of both files";
  std::ofstream(folder / "roads" / "picture.png") << "one";
  EXPECT_EQ(failure(settings, folder / "elsewhere"), "world-roads-are-pictures");

  settings.roads = roads;
  settings.centre = LatLon{57.80, 11.965};
  EXPECT_EQ(failure(settings, folder / "elsewhere"), "world-without-roads");
  EXPECT_FALSE(std::filesystem::exists(folder / "elsewhere"));
}

TEST(World, RefusesSettingsThatCannotBeMet) {
  const TemporaryFolder folder;
  const auto code_with = [&](auto change) {
    WorldSettings settings = small_settings();
    change(settings);
    return failure(settings, folder / "world");
  };
  EXPECT_EQ(code_with([](auto& s) { s.width_m = 50.0; }), "parameter-out-of-range");
  EXPECT_EQ(code_with([](auto& s) { s.height_m = 1e9; }), "parameter-out-of-range");
  EXPECT_EQ(code_with([](auto& s) { s.width_m = std::nan(""); }), "parameter-out-of-range");
  EXPECT_EQ(code_with([](auto& s) { s.gsd_m = 0.0; }), "parameter-out-of-range");
  EXPECT_EQ(code_with([](auto& s) { s.collapsed_share = 1.5; }), "parameter-out-of-range");
  EXPECT_EQ(code_with([](auto& s) { s.frames = -1; }), "parameter-out-of-range");
  EXPECT_EQ(code_with([](auto& s) { s.footprint_m = 300.0; }), "world-too-small-for-frames");
  EXPECT_EQ(code_with([](auto& s) {
              s.land = Land::kCountry;
              s.roads = "roads.geojson";
            }),
            "world-land-roads");
  EXPECT_EQ(code_with([](auto& s) { s.roads = "no-such-file.geojson"; }), "file-not-found");
  EXPECT_FALSE(std::filesystem::exists(folder / "world"));
}

TEST(World, HasBlocksBuildingsAndTreesEvenWhenSmall) {
  const TemporaryFolder folder;
  WorldSettings settings = small_settings(5);
  settings.frames = 0;
  const WorldReport report = render(settings, folder.path());
  EXPECT_GT(report.blocks, 3);
  EXPECT_GT(report.buildings, 40);
  EXPECT_GT(report.trees, 100);
}

}  // namespace
}  // namespace roadfix::world
