// roadfix ingest as a whole: killed anywhere, stopped, fed with damaged files.
#include <gmock/gmock.h>
#include <signal.h>
#include <sqlite3.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "tests/e2e/ingest_fixture.hpp"

namespace roadfix {
namespace {

using testing::ChildResult;
using testing::IngestCommand;
using testing::RasterSpec;
using testing::write_raster;
using namespace std::chrono_literals;

/// Bytes of every tile of the map.
std::map<std::tuple<int, int, int>, std::string> tiles(const std::string& path) {
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

TEST_F(IngestCommand, KilledAtManyPointsItEndsWithTheSameTiles) {
  // As many blocks as a larger picture has, since the cells are small.
  const std::vector<std::string> source{picture(1200, 1.0), "--detector", "tree",   "--cell", "1",
                                        "--seed",           "3",          "--jobs", "2",      "--map"};
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
                                                 {"none.tif", "file-not-found"},
                                                 {"nowhere.tif", "image-without-georeference"},
                                                 {"wrong.tif", "crs-not-transformable"}};
  for (const auto& [file, code] : cases) {
    const ChildResult result = ingest({folder / file, "--detector", "tree", "--map", map("bad.gpkg")});
    EXPECT_EQ(result.code, 1) << file;
    EXPECT_THAT(result.err, ::testing::HasSubstr("[" + code + "]")) << file;
    EXPECT_THAT(result.err, ::testing::HasSubstr(file));
    EXPECT_FALSE(std::filesystem::exists(map("bad.gpkg"))) << file;
  }
  EXPECT_EQ(ingest({good, "--cell", "3", "--detector", "tree", "--map", map("bad.gpkg")}).code, 2);
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

}  // namespace
}  // namespace roadfix
