// Real road data becomes a map; a window cut out of it, turned by an odd angle, finds its own place again.
#include <gtest/gtest.h>

#include <cstdlib>

#include "core/grid/resample.hpp"
#include "core/locate/fix.hpp"
#include "core/units/draws.hpp"
#include "tests/support/real_data.hpp"
#include "tests/support/street_map.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tiles/view/map_file_view.hpp"

namespace roadfix {
namespace {

using testing::real_data;

struct Outcome {
  int fixes = 0;
  int windows = 0;
};

/// Poses with at least 3 % road under a footprint of 400 m; the best place must be the pose itself.
void locate_windows(const std::filesystem::path& map, Outcome& outcome) {
  const MapView view = view_of(std::make_shared<MapReader>(map), "real");
  std::mt19937_64 random(7);
  for (int draws = 0; outcome.windows < 4 && draws < 500; ++draws) {
    const GridPose truth{{uniform(random, view.extent.min.east_m, view.extent.max.east_m),
                          uniform(random, view.extent.min.north_m, view.extent.max.north_m)},
                         Angle::degrees(uniform(random, 0, 360))};
    const GridBox around{{truth.position.east_m - 300.0, truth.position.north_m - 300.0},
                         {truth.position.east_m + 300.0, truth.position.north_m + 300.0}};
    const FeatureMap window =
        cut_out(view.read(GridGeometry::covering(around, view.cell_m)), truth, 200, 200, view.cell_m);
    double road = 0.0;
    for (const Cell cell : window.cells.cells()) road += is_observed(cell) ? probability(cell) : 0.0;
    if (road < 0.03 * 200 * 200) continue;
    ++outcome.windows;
    Prior prior;
    prior.circle = GeoCircle{view.zone.unproject({truth.position.east_m + 300.0, truth.position.north_m}), 800.0};
    const Fix fix = locate(view, window, prior, {});
    if (fix.status == FixStatus::kFix) ++outcome.fixes;
    ASSERT_FALSE(fix.modes.empty());
    const GridPoint found = view.zone.project(fix.modes[0].pose.position);
    EXPECT_LT(distance_m(found, truth.position), 0.5 * view.cell_m);
    const Angle heading = view.zone.grid_from_true(fix.modes[0].pose.heading, found);
    EXPECT_LT(angular_distance(heading, truth.heading).degrees(), 1.0);
  }
}

int ingest(const std::string& arguments) {
  return std::system((ROADFIX_PROGRAM " ingest " + arguments + " >/dev/null 2>&1").c_str());
}

TEST(RealMaps, WindowsOfGothenburgFromVectorsFindTheirPlace) {
  const auto roads = real_data("osm/gothenburg/gothenburg_highways.geojson");
  if (!std::filesystem::exists(roads)) GTEST_SKIP() << roads << " is not there";
  const testing::TemporaryFolder folder;
  const auto map = folder / "gothenburg.gpkg";
  ASSERT_EQ(ingest(roads.string() + " --map " + map.string()), 0);
  Outcome outcome;
  locate_windows(map, outcome);
  EXPECT_EQ(outcome.windows, 4);
  EXPECT_GE(outcome.fixes, 1);
}

TEST(RealMaps, WindowsOfMassachusettsFromMasksFindTheirPlace) {
  const auto masks = real_data("massachusetts-roads/masks");
  if (!std::filesystem::exists(masks)) GTEST_SKIP() << masks << " is not there";
  const testing::TemporaryFolder folder;
  const auto map = folder / "massachusetts.gpkg";
  ASSERT_EQ(ingest(masks.string() + " --as roads --map " + map.string()), 0);
  Outcome outcome;
  locate_windows(map, outcome);
  EXPECT_EQ(outcome.windows, 4);
  EXPECT_GE(outcome.fixes, 1);
}

}  // namespace
}  // namespace roadfix
