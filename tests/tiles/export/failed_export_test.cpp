// What cannot be exported leaves nothing behind.
#include <gmock/gmock.h>

#include <stdexcept>
#include <utility>

#include "tests/support/room.hpp"
#include "tests/tiles/export/map_export_fixture.hpp"

namespace roadfix {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::MapExport;
using ::testing::Not;
using testing::Room;
using testing::settings_37n;
using ::testing::StartsWith;

TEST_F(MapExport, RefusesWhatCannotBeExportedAndLeavesNothingBehind) {
  EXPECT_EQ(code_of(folder / "out.tif", {.cell_m = 3.0}), "cell-size-not-in-map");
  EXPECT_EQ(code_of(folder / "out.tif", {.box = GridBox{{0, 0}, {100, 100}}}), "region-outside-map");
  EXPECT_THAT(testing::message_of([&] {
                export_map(MapReader(path), folder / "out.tif", {.box = GridBox{{0, 0}, {100, 100}}});
              }),
              HasSubstr("ground of the map, which shows latitude "));
  EXPECT_EQ(code_of(folder / "no/such/folder/out.tif", {}), "export-failed");
  std::stop_source stop;
  stop.request_stop();
  EXPECT_EQ(code_of(folder / "out.tif", {}, stop.get_token()), "work-stopped");
  EXPECT_EQ(files(), 1U);
  { MapWriter(folder / "empty.gpkg", settings_37n()); }
  EXPECT_THROW(export_map(MapReader(folder / "empty.gpkg"), folder / "out.tif", {}), InvalidInput);
}

TEST_F(MapExport, SaysWhenTheLastByteFindsNoRoomAndLeavesNothingBehind) {
  for (const auto& [name, format] : {std::pair("out.tif", ExportFormat::kCog),
                                     {"out.tif", ExportFormat::kGeoTiff},
                                     {"out.png", ExportFormat::kPng},
                                     {"out.mbtiles", ExportFormat::kMbTiles}}) {
    const auto target = folder / name;
    export_map(MapReader(path), target, {.format = format});
    const std::uintmax_t whole = fs::file_size(target);
    fs::remove(target);
    for (const char* beside : {"out.wld", "out.png.aux.xml"}) fs::remove(folder / beside);
    const ExportOptions options{.format = format};
    const Room room(whole - 1);
    EXPECT_EQ(code_of(target, options), "export-failed") << name;
    EXPECT_THAT(testing::message_of([&] { export_map(MapReader(path), target, options); }),
                AllOf(StartsWith(target.string() + ": "), Not(HasSubstr("unfinished"))));
    EXPECT_EQ(files(), 1U);
  }
}

TEST_F(MapExport, ADamagedTileEndsTheExportAndIsNamed) {
  testing::open_sqlite(path).execute("UPDATE road_probability SET tile_data = x'00'");
  for (const auto format : {ExportFormat::kCog, ExportFormat::kPng, ExportFormat::kMbTiles}) {
    EXPECT_EQ(code_of(folder / "out", {.format = format}), "tile-corrupt");
  }
  EXPECT_EQ(files(), 1U);
}

TEST_F(MapExport, PassesOnWhatTheOneWhoWatchesItThrows) {
  for (const auto format : {ExportFormat::kCog, ExportFormat::kPng, ExportFormat::kMbTiles}) {
    const auto watch = [](std::int64_t, std::int64_t) { throw std::runtime_error("the terminal has gone"); };
    EXPECT_THROW(export_map(MapReader(path), folder / "out", {.format = format}, watch), std::runtime_error);
    EXPECT_EQ(files(), 1U);
  }
}

TEST_F(MapExport, LeavesTheFilesOfAnotherToTheSameTargetAlone) {
  for (const auto format : {ExportFormat::kCog, ExportFormat::kPng, ExportFormat::kMbTiles}) {
    bool began = false;
    const auto other = [&](std::int64_t, std::int64_t) {
      if (!std::exchange(began, true)) export_map(MapReader(path), folder / "out", {.format = format});
    };
    EXPECT_NO_THROW(export_map(MapReader(path), folder / "out", {.format = format}, other));
    EXPECT_TRUE(began);
  }
}

}  // namespace
}  // namespace roadfix
