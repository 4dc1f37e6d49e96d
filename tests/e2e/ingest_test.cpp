// roadfix ingest as a whole: killed anywhere, stopped, fed with damaged files.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <signal.h>
#include <sqlite3.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "tests/e2e/child_process.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/tiles/sources/test_raster.hpp"

namespace roadfix {
namespace {

using testing::ChildResult;
using ::testing::HasSubstr;
using testing::RasterSpec;
using testing::run_child;
using testing::write_raster;
using namespace std::chrono_literals;

class IngestCommand : public ::testing::Test {
 protected:
  ChildResult ingest(std::vector<std::string> arguments, std::chrono::microseconds kill_after = {},
                     int signal = 9) const {
    arguments.insert(arguments.begin(), "ingest");
    return run_child(ROADFIX_PROGRAM, arguments, folder.path(), kill_after, signal);
  }
  std::string map(const std::string& name) const { return folder / name; }

  /// Bytes of every tile of the map.
  static std::map<std::tuple<int, int, int>, std::string> tiles(const std::string& path) {
    sqlite3* file = nullptr;
    sqlite3_stmt* select = nullptr;
    std::map<std::tuple<int, int, int>, std::string> result;
    EXPECT_EQ(sqlite3_open_v2(path.c_str(), &file, SQLITE_OPEN_READONLY, nullptr), SQLITE_OK);
    EXPECT_EQ(sqlite3_prepare_v2(file, "SELECT zoom_level, tile_column, tile_row, tile_data FROM road_probability", -1,
                                 &select, nullptr),
              SQLITE_OK);
    while (sqlite3_step(select) == SQLITE_ROW) {
      const auto* bytes = static_cast<const char*>(sqlite3_column_blob(select, 3));
      const auto size = static_cast<std::size_t>(sqlite3_column_bytes(select, 3));
      result[{sqlite3_column_int(select, 0), sqlite3_column_int(select, 1), sqlite3_column_int(select, 2)}] =
          std::string(bytes, size);
    }
    sqlite3_finalize(select);
    sqlite3_close(file);
    return result;
  }

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

  testing::TemporaryFolder folder;
};

TEST_F(IngestCommand, KilledAtManyPointsItEndsWithTheSameTiles) {
  const std::vector<std::string> source{picture(2000, 1.0), "--detector", "tree", "--seed", "3",
                                        "--jobs",           "2",          "--map"};
  const auto with_map = [&](const std::string& path) {
    std::vector<std::string> arguments = source;
    arguments.push_back(path);
    return arguments;
  };
  const auto start = std::chrono::steady_clock::now();
  const ChildResult whole = ingest(with_map(map("whole.gpkg")));
  ASSERT_EQ(whole.code, 0) << whole.err;
  const auto duration = std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now() - start);
  const auto expected = tiles(map("whole.gpkg"));
  ASSERT_GT(expected.size(), 25U);

  std::mt19937_64 random(11);
  int kills = 0;
  for (int attempt = 0; attempt < 60; ++attempt) {
    // From the first moments (creating the file) to about a fifth of the whole run.
    const std::chrono::microseconds delay(
        1000 + static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(duration.count() / 5)));
    const ChildResult part = ingest(with_map(map("parts.gpkg")), delay);
    if (!part.killed) {
      ASSERT_EQ(part.code, 0) << part.err;
      break;
    }
    ++kills;
  }
  EXPECT_GT(kills, 0);
  const ChildResult last = ingest(with_map(map("parts.gpkg")));
  ASSERT_EQ(last.code, 0) << last.err;
  EXPECT_EQ(tiles(map("parts.gpkg")), expected) << "after " << kills << " kills";
}

TEST_F(IngestCommand, CtrlCStopsCleanlyAndSaysHowToGoOn) {
  // Some seconds of work, on any machine.
  const std::vector<std::string> arguments{picture(1600, 1.0), "--detector", "tree", "--jobs", "1", "--map",
                                           map("a.gpkg")};
  const ChildResult stopped = ingest(arguments, 1500ms, SIGINT);
  EXPECT_FALSE(stopped.killed);
  if (stopped.code == 0) GTEST_SKIP() << "it was done before the signal came";
  EXPECT_EQ(stopped.code, 1);
  EXPECT_THAT(stopped.err, ::testing::HasSubstr("again"));
  EXPECT_EQ(ingest(arguments).code, 0);
}

TEST_F(IngestCommand, BadInputGetsOneLineACodeAndNoMap) {
  const std::string good = picture(300, 1.0);
  std::ofstream(folder / "zero.tif") << "";
  std::ofstream(folder / "header.tif") << "II*and then no TIFF at all";
  write_raster(folder / "nowhere.tif", {.epsg = 0, .transform = std::nullopt}, [](int, int, int) { return 1.0; });
  RasterSpec metres_as_degrees;
  metres_as_degrees.epsg = 4326;
  write_raster(folder / "wrong.tif", metres_as_degrees, [](int, int, int) { return 1.0; });
  const std::map<std::string, std::string> cases{{"zero.tif", "source-unreadable"},
                                                 {"header.tif", "source-unreadable"},
                                                 {"none.tif", "source-not-found"},
                                                 {"nowhere.tif", "image-without-georeference"},
                                                 {"wrong.tif", "crs-not-transformable"}};
  for (const auto& [file, code] : cases) {
    const ChildResult result = ingest({folder / file, "--detector", "tree", "--map", map("bad.gpkg")});
    EXPECT_EQ(result.code, 1) << file;
    EXPECT_THAT(result.err, ::testing::HasSubstr("[" + code + "]")) << file;
    EXPECT_THAT(result.err, ::testing::HasSubstr(file));
    EXPECT_FALSE(std::filesystem::exists(map("bad.gpkg"))) << file;
  }
  EXPECT_EQ(ingest({good, "--cell", "3", "--detector", "tree", "--map", map("bad.gpkg")}).code, 1);
  EXPECT_EQ(ingest({good}).code, 2);
  EXPECT_EQ(ingest({good, "--map", map("bad.gpkg"), "--jobs", "0"}).code, 2);
}

TEST_F(IngestCommand, ATruncatedImageKeepsItsSourceIncompleteUntilTheFileIsWhole) {
  const std::string image = picture(2000, 1.0);
  std::filesystem::copy_file(image, folder / "whole.tif");
  const auto time = std::filesystem::last_write_time(image);
  std::filesystem::resize_file(image, std::filesystem::file_size(image) / 2);
  const ChildResult result = ingest({image, "--as", "roads", "--map", map("a.gpkg")});
  EXPECT_EQ(result.code, 1);
  EXPECT_THAT(result.err,
              ::testing::AllOf(::testing::HasSubstr("[image-unreadable-block]"), ::testing::HasSubstr("city.tif")));
  std::filesystem::copy_file(folder / "whole.tif", image, std::filesystem::copy_options::overwrite_existing);
  std::filesystem::last_write_time(image, time);
  const ChildResult again = ingest({image, "--as", "roads", "--replace", "--map", map("a.gpkg")});
  EXPECT_EQ(again.code, 0) << again.err;
  const ChildResult undisturbed = ingest({image, "--as", "roads", "--map", map("b.gpkg")});
  EXPECT_EQ(undisturbed.code, 0) << undisturbed.err;
  EXPECT_EQ(tiles(map("a.gpkg")), tiles(map("b.gpkg")));
}

TEST_F(IngestCommand, AFirstIngestThatFailsAtOnceLeavesNoMap) {
  const std::string image = picture(2000, 1.0);
  std::filesystem::resize_file(image, 4096);
  const ChildResult first = ingest({image, "--as", "roads", "--map", map("a.gpkg")});
  EXPECT_EQ(first.code, 1);
  EXPECT_THAT(first.err, ::testing::HasSubstr("[image-unreadable-block]"));
  EXPECT_FALSE(std::filesystem::exists(map("a.gpkg")));
  std::filesystem::rename(image, folder / "cut.tif");
  ASSERT_EQ(ingest({picture(300, 1.0), "--as", "roads", "--map", map("a.gpkg")}).code, 0);
  const auto before = tiles(map("a.gpkg"));
  EXPECT_EQ(ingest({folder / "cut.tif", "--as", "roads", "--map", map("a.gpkg")}).code, 1);
  EXPECT_EQ(tiles(map("a.gpkg")), before) << "what was there is kept";
}

TEST_F(IngestCommand, ANewMapAroundTheEquatorHoldsBothSides) {
  std::ofstream(folder / "quito.geojson")
      << R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{"highway":"primary"},)"
      << R"("geometry":{"type":"LineString","coordinates":[[33.0,-0.004],[33.01,0.012]]}}]})";
  const std::string roads = folder / "quito.geojson";
  const ChildResult both = ingest({roads, "--map", map("both.gpkg")});
  EXPECT_EQ(both.code, 0) << both.err;
  const ChildResult info = run_child(ROADFIX_PROGRAM, {"info", map("both.gpkg")}, folder.path());
  EXPECT_THAT(info.out, ::testing::AllOf(::testing::HasSubstr("EPSG:32736"), ::testing::HasSubstr("latitude -0.00")));
  const ChildResult north = ingest({roads, "--zone", "EPSG:32636", "--map", map("north.gpkg")});
  EXPECT_EQ(north.code, 0) << north.err;
  EXPECT_THAT(north.err, ::testing::AllOf(::testing::HasSubstr("south of the equator is left out"),
                                          ::testing::HasSubstr("--zone EPSG:32736")));
}

TEST_F(IngestCommand, ASourceFarFromTheZoneOfTheMapHearsOfBothChoices) {
  const auto road = [&](const std::string& name, double lon_deg) {
    std::ofstream(folder / name) << R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{)"
                                 << R"("highway":"primary"},"geometry":{"type":"LineString","coordinates":[[)"
                                 << lon_deg << ",37.76],[" << lon_deg + 0.01 << ",37.77]]}}]}";
    return std::string(folder / name);
  };
  const std::string home = road("home.geojson", 40.0);
  const std::string far = road("far.geojson", 46.0);
  ASSERT_EQ(ingest({home, "--map", map("a.gpkg")}).code, 0);
  write_raster(folder / "far.tif", {.epsg = 32638, .transform = std::array{588000.0, 1.0, 0.0, 4180000.0, 0.0, -1.0}},
               [](int, int, int) { return 1.0; });
  for (const std::string& source : {far, std::string(folder / "far.tif")}) {
    const ChildResult refused = ingest({source, "--as", "roads", "--map", map("a.gpkg")});
    EXPECT_EQ(refused.code, 1) << source;
    EXPECT_THAT(refused.err, ::testing::AllOf(HasSubstr("[source-in-another-zone]"), HasSubstr("another --map"),
                                              HasSubstr("--zone EPSG:32638"), HasSubstr("0.3 % too long")));
  }
  EXPECT_EQ(ingest({far, "--map", map("own.gpkg")}).code, 0);
  const ChildResult both = ingest({far, home, "--zone", "EPSG:32638", "--map", map("both.gpkg")});
  EXPECT_EQ(both.code, 0) << both.err;
  EXPECT_THAT(both.err, HasSubstr("% too long"));
  const ChildResult near = ingest({road("near.geojson", 44.0), "--map", map("a.gpkg")});
  EXPECT_EQ(near.code, 0);
  EXPECT_THAT(near.err, ::testing::AllOf(HasSubstr(" km from the central meridian of EPSG:32637"),
                                         HasSubstr("0.20 % too long"), HasSubstr("another --map")));
}

TEST_F(IngestCommand, ASourceMadeTooLargeByAStrayRoadHearsOfTheExtentOfTheOthers) {
  const auto line = [](double lon, double lat) {
    return fmt::format(R"({{"type":"Feature","geometry":{{"type":"LineString","coordinates":[[{},{}],[{},{}]]}}}})",
                       lon, lat, lon + 0.002, lat + 0.002);
  };
  std::ofstream file(folder / "town.geojson");
  file << R"({"type":"FeatureCollection","features":[)" << line(0.0, 0.0);
  for (int row = 0; row < 10; ++row) {
    for (int col = 0; col < 10; ++col) file << ',' << line(38.2 + 0.001 * col, 37.7 + 0.001 * row);
  }
  file << "]}";
  file.close();
  const std::string source = folder / "town.geojson";
  const ChildResult all = ingest({source, "--map", map("m.gpkg")});
  EXPECT_EQ(all.code, 1);
  EXPECT_THAT(all.err, HasSubstr("100 of its 101 roads"));
  EXPECT_THAT(all.err, HasSubstr("[source-too-large]"));
  const std::size_t start = all.err.find("--extent ") + 9;
  const std::string extent = all.err.substr(start, all.err.find(' ', start) - start);
  EXPECT_EQ(ingest({source, "--map", map("m.gpkg"), "--extent", extent}).code, 0) << extent;
}

TEST_F(IngestCommand, AFolderOfImagesFarApartIsToldToBeSplit) {
  std::filesystem::create_directory(folder / "images");
  const auto one = [](int, int, int) { return 1.0; };
  RasterSpec there;
  write_raster(folder / "images/a.tif", there, one);
  there.epsg = 32719;
  write_raster(folder / "images/b.tif", there, one);
  const ChildResult result = ingest({folder / "images", "--detector", "tree", "--map", map("a.gpkg")});
  EXPECT_EQ(result.code, 1);
  EXPECT_THAT(result.err, ::testing::AllOf(HasSubstr("b.tif: its coordinates in EPSG:32719 have no place"),
                                           HasSubstr("folder of their own"), HasSubstr("[source-in-several-zones]")));
}

TEST_F(IngestCommand, AnImageThatShowsNothingIsSaidToShowNothing) {
  const std::string image =
      write_raster(folder / "empty.tif", RasterSpec{.nodata = 0.0}, [](int, int, int) { return 0; });
  const ChildResult result = ingest({image, "--as", "roads", "--map", map("a.gpkg")});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.err,
              ::testing::AllOf(HasSubstr("nothing of " + image + " was observed"), HasSubstr("in one colour")));
}

TEST_F(IngestCommand, ACopyUnderAnotherNameIsNoticed) {
  const std::string image = picture(600, 0.5);
  const std::string copy = folder / "the copy's.tif";
  std::filesystem::copy_file(image, copy);
  const std::string target = map("my town.gpkg");
  EXPECT_EQ(ingest({image, "--name", "first", "--detector", "tree", "--map", target}).code, 0);
  const ChildResult again = ingest({copy, "--detector", "tree", "--map", target});
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_THAT(again.err, HasSubstr("'the copy's' says exactly what the source 'first' says"));
  EXPECT_THAT(again.err, HasSubstr("take it out: roadfix remove '" + target + R"(' 'the copy'\''s')"));
}

TEST_F(IngestCommand, ASourceThatLiesBesideTheOthersIsNoticed) {
  const auto streets = [&](const std::string& name, double east_deg) {
    std::string features;
    double at = 0.0;
    for (int i = 0; i < 16; ++i) {
      at += 0.0008 + 0.0003 * (i * i % 5);
      const double lon = 38.25 + at + east_deg;
      const double lat = 37.75 + at;
      features += fmt::format(
          R"({}{{"type": "Feature", "properties": {{"highway": "residential"}}, "geometry": {{"type": "MultiLineString",
          "coordinates": [[[{}, 37.75], [{}, 37.78]], [[{}, {}], [{}, {}]]]}}}})",
          i == 0 ? "" : ",", lon, lon, 38.25 + east_deg, lat, 38.28 + east_deg, lat);
    }
    std::string path = folder / (name + ".geojson");
    std::ofstream(path) << R"({"type": "FeatureCollection", "features": [)" << features << "]}";
    return path;
  };
  EXPECT_EQ(ingest({streets("first", 0.0), "--map", map("m.gpkg")}).code, 0);
  EXPECT_THAT(ingest({streets("again", 0.00003), "--map", map("m.gpkg")}).err, ::testing::Not(HasSubstr("would fit")))
      << "2.6 m";
  const ChildResult beside = ingest({streets("beside", 0.0003), "--map", map("m.gpkg")});
  EXPECT_EQ(beside.code, 0) << beside.err;
  EXPECT_THAT(beside.err, HasSubstr("'beside' would fit the other sources of the map better about"));
  EXPECT_THAT(beside.err, HasSubstr("m to the west"));
}

TEST_F(IngestCommand, ADryRunPrintsThePlanAndWritesNothing) {
  const ChildResult result = ingest({picture(600, 0.5), "--detector", "tree", "--dry-run", "--map", map("a.gpkg")});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.out, ::testing::HasSubstr("EPSG:32637"));
  EXPECT_FALSE(std::filesystem::exists(map("a.gpkg")));
}

}  // namespace
}  // namespace roadfix
