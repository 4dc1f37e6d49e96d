#include "core/track/recent_frames.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/grid/resample.hpp"
#include "core/locate/fix.hpp"
#include "core/units/error.hpp"
#include "tests/support/map_view.hpp"
#include "tests/support/street_map.hpp"

namespace roadfix {
namespace {

constexpr OdometryCovariance kExact{};
constexpr OdometryCovariance kUsual{{{1.0, 0, 0}, {0, 1.0, 0}, {0, 0, 1e-4}}};

FeatureMap blank(int side, double cell_m = 2.0) { return FeatureMap::centred(CellArray(side, side, kNoRoad), cell_m); }

std::size_t cells_of(const RecentFrames& recent) {
  std::size_t sum = 0;
  for (const auto& frame : recent.frames()) sum += frame.placed.features.cells.cells().size();
  return sum;
}

TEST(RecentFrames, LieWhereTheVehicleSawThem) {
  const RoadGrid map = testing::street_map(31, {2.0, {300'000, -3'200'000}, 500, 500});
  GridPose pose{{600'450.0, 6'399'500.0}, Angle::degrees(35.0)};
  RecentFrames recent;
  for (const Odometry& step :
       {Odometry{70.0, 10.0, Angle::degrees(40.0)}, {65.0, -20.0, Angle::degrees(-75.0)}, {80.0, 0.0, Angle()}}) {
    recent.keep(cut_out(map, pose, 80, 80, 2.0));
    pose = moved(pose, step);
    recent.move(step, kExact);
  }
  ASSERT_EQ(recent.frames().size(), 3U);
  const FeatureMap laid = recent.laid_around(cut_out(map, pose, 80, 80, 2.0));
  // The same ground, cut out at once.
  const int side = 2 * std::max(laid.cells.cols(), laid.cells.rows());
  const FeatureMap whole = cut_out(map, pose, side, side, 2.0);
  const int right = static_cast<int>(std::lround(side / 2.0 - laid.nadir.col));
  const int down = static_cast<int>(std::lround(side / 2.0 - laid.nadir.row));
  double difference = 0.0;
  int roads = 0;
  for (int row = 0; row < laid.cells.rows(); ++row) {
    for (int col = 0; col < laid.cells.cols(); ++col) {
      const Cell seen = laid.cells.at(col, row);
      const Cell there = whole.cells.get(col + right, row + down);
      if (!is_observed(seen) || !is_observed(there)) continue;
      difference += std::abs(probability(seen) - probability(there));
      roads += probability(there) > 0.5 ? 1 : 0;
    }
  }
  EXPECT_GT(laid.cells.observed_count(), 2U * 80 * 80);
  EXPECT_LT(difference, 0.5 * roads) << "the cells at the rims of roads differ, which is less than the roads";
}

TEST(RecentFrames, AreOneWhileTheVehicleHovers) {
  RecentFrames recent;
  for (int i = 0; i < 50; ++i) {
    recent.keep(blank(100));
    recent.move({i % 2 == 0 ? 10.0 : -10.0, 0.0, Angle::degrees(30.0)}, kExact);
  }
  EXPECT_EQ(recent.frames().size(), 1U);
}

TEST(RecentFrames, AreBoundedInNumberGroundAndReach) {
  for (const int side : {100, 300, 512}) {
    RecentFrames recent;
    for (int i = 0; i < 60; ++i) {
      recent.keep(blank(side));
      recent.move({0.26 * side * 2.0, 0.0, Angle::degrees(i % 7 * 20.0)}, kExact);
      EXPECT_LE(recent.frames().size(), RecentFrames::kMaxFrames);
      EXPECT_LE(cells_of(recent), RecentFrames::kMaxCells);
      for (const auto& frame : recent.frames()) {
        EXPECT_LE(distance_m(frame.placed.offset), RecentFrames::kMaxSides * 2.0 * side);
      }
    }
    EXPECT_GE(recent.frames().size(), 2U);
  }
  RecentFrames recent;
  recent.keep(blank(RecentFrames::kMaxAcross + 1));
  EXPECT_TRUE(recent.frames().empty()) << "shows enough by itself";
}

TEST(RecentFrames, AreLetGoOfWhenTheOdometryMayHaveLostThem) {
  RecentFrames recent;
  recent.keep(blank(200));
  int steps = 0;
  for (; !recent.frames().empty() && steps < 100; ++steps) recent.move({5.0, 0.0, Angle()}, kUsual);
  // 1 m and 0.57 degrees a step: those turn the frame's rim, 200 m off its middle, by 2 m and its place by as much.
  EXPECT_GT(steps, 20);
  EXPECT_LT(steps, 60);
}

TEST(RecentFrames, AreOfOneCellSize) {
  RecentFrames recent;
  recent.keep(blank(100, 2.0));
  recent.move({60.0, 0.0, Angle()}, kExact);
  EXPECT_TRUE(recent.laid_around(blank(100, 4.0)) == blank(100, 4.0)) << "nothing of another size is laid with it";
  recent.keep(blank(100, 4.0));
  ASSERT_EQ(recent.frames().size(), 1U);
  EXPECT_EQ(recent.frames().front().placed.features.cell_m, 4.0);
}

/// Patches of 300 m in three rows, each pair of neighbours twice, and a-b-c in the northernmost row alone.
class TownOfPatches : public ::testing::Test {
 protected:
  static constexpr int kPatch = 150;

  static RoadGrid town() {
    RoadGrid town{{2.0, {300'000, -3'200'000}, 3 * kPatch, 3 * kPatch}, CellArray(3 * kPatch, 3 * kPatch, kNoRoad)};
    const std::array<const char*, 3> rows{"abc", "dab", "bcd"};
    for (int row = 0; row < 3; ++row) {
      for (int col = 0; col < 3; ++col) {
        const char kind = rows.at(static_cast<std::size_t>(row))[col];
        const RoadGrid patch = testing::street_map(static_cast<std::uint64_t>(kind), {2.0, {0, 0}, kPatch, kPatch});
        paste(patch.cells, town.cells, col * kPatch, row * kPatch);
      }
    }
    return town;
  }
  /// Over the northernmost row, so many metres from its western end, heading east.
  GridPose over(double metres) const {
    const GridBox box = map_.geometry.box();
    return {{box.min.east_m + metres, box.max.north_m - kPatch}, Angle::degrees(90.0)};
  }

  RoadGrid map_ = town();
  MapView view_ = testing::view_of(map_);
};

TEST_F(TownOfPatches, IsToldByFramesTogetherWhereEachOfThemFitsTwice) {
  std::mt19937_64 random(5);
  RecentFrames recent;
  FeatureMap last;
  for (const double metres : {300.0, 450.0, 600.0}) {
    last = testing::observed_at(map_, over(metres), 120, 120, 2.0, {0.1, 0.1}, random);
    const Fix alone = locate(view_, last, {}, {});
    EXPECT_EQ(alone.status, FixStatus::kAmbiguous) << metres << ' ' << alone.explanation;
    if (metres == 600.0) break;
    recent.keep(last);
    recent.move({150.0, 0.0, Angle()}, kExact);
  }
  const Fix together = locate(view_, recent.laid_around(last), {}, {});
  ASSERT_EQ(together.status, FixStatus::kFix) << together.explanation;
  EXPECT_LT(distance_m(view_.zone.project(together.modes.front().pose.position), over(600.0).position), 10.0);
}

}  // namespace
}  // namespace roadfix
