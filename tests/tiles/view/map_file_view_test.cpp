#include "tiles/view/map_file_view.hpp"

#include <gtest/gtest.h>

#include "core/locate/fix.hpp"
#include "tests/support/map_file.hpp"
#include "tests/support/street_map.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roadfix {
namespace {

TEST(MapFileView, AMapFileAnswersWhereAFootprintWasSeen) {
  const RoadGrid town = testing::street_map(31, {2.0, {300'100, -3'200'050}, 700, 600});
  const testing::TemporaryFolder folder;
  testing::write_map_file(folder / "town.gpkg", town, 1.5);
  const MapView view = view_of(std::make_shared<MapReader>(folder / "town.gpkg"), "town");
  EXPECT_EQ(view.name, "town");
  EXPECT_FALSE(view.version.empty());
  EXPECT_EQ(view.registration_sigma_m(town.geometry.box().centre()), 1.5);

  std::mt19937_64 random(32);
  const GridPose truth{{600'900.0, 6'399'300.0}, Angle::degrees(123.0)};
  const Fix fix = locate(view, testing::observed_at(town, truth, 170, 170, 2.0, {0.1, 0.1}, random), {}, {});
  ASSERT_EQ(fix.status, FixStatus::kFix) << fix.reason;
  EXPECT_LT(distance_m(view.zone.project(fix.modes[0].pose.position), truth.position), 1.5);
  EXPECT_GT(fix.modes[0].sigma_m[1], 1.5) << "the registration error of the map is part of the answer's";
  EXPECT_EQ(fix.map_version, view.version);
}

TEST(MapFileView, ASourceCountsForTheAccuracyOfTheGroundAroundItOnly) {
  const testing::TemporaryFolder folder;
  const std::filesystem::path path = folder / "town.gpkg";
  const RoadGrid town = testing::street_map(31, {2.0, {300'100, -3'200'050}, 700, 600});
  testing::write_map_file(path, town, 1.5);
  {
    MapWriter writer(path, {UtmZone::from_epsg(32634).value(), 2.0});
    const SourceRecord coarse{.name = "coarse",
                              .kind = "roads",
                              .location = "coarse.geojson",
                              .fingerprint = "coarse",
                              .method = "drawn",
                              .provenance = {.registration_sigma_m = 40.0}};
    const GridGeometry far{2.0, {310'000, -3'200'050}, 1, 1};
    for (const TileIndex block : writer.begin_source(coarse, tiles_covering(far), false)) {
      testing::put_block(writer, coarse.name, block, CellArray(kTileCells, kTileCells, kNoRoad));
    }
    writer.finish_source(coarse.name);
  }
  const MapView view = view_of(std::make_shared<MapReader>(path), "town");
  EXPECT_EQ(view.registration_sigma_m(town.geometry.box().centre()), 1.5);
  EXPECT_EQ(view.registration_sigma_m({620'000.0, 6'400'100.0}), 40.0);
  EXPECT_EQ(view.registration_sigma_m({640'000.0, 6'400'100.0}), 40.0) << "beyond all sources";
}

}  // namespace
}  // namespace roadfix
