#include "server/api/features.hpp"

#include <gtest/gtest.h>

#include "core/locate/told_frames.hpp"
#include "tests/support/ascii_map.hpp"
#include "tests/support/random_cells.hpp"

namespace roadfix::api {
namespace {

Features seen_in(std::chrono::milliseconds time, double agl_m) {
  std::mt19937_64 random(static_cast<std::uint64_t>(agl_m));
  FrameCamera camera;
  camera.agl_m = agl_m;
  return {FeatureMap::centred(testing::smooth_cells(random, 20, 16), 2.0), time, camera};
}

TEST(Features, OfSeveralFramesTakeTheTimeOfAllAndHaveTheCameraOfTheFirst) {
  using std::chrono::milliseconds;
  const Features first = seen_in(milliseconds(100), 40.0);
  const OtherFeatures other{seen_in(milliseconds(30), 80.0), {25.0, 0.0, Angle::degrees(-20.0)}};
  const Features all = together(first, {other}, 1e6);
  EXPECT_EQ(all.detect_time, milliseconds(130));
  EXPECT_EQ(all.camera_in_file.value().agl_m, 40.0);
  EXPECT_EQ(all.own_frame, first.map);
  const std::vector<PlacedFeatures> parts{{first.map, {}}, {other.features.map, other.offset}};
  EXPECT_EQ(all.map, laid_together(parts, 1e6).features);
}

TEST(Features, SayWhichFramesWereLeftOut) {
  const auto seen = [](const char* rows) { return Features{FeatureMap::centred(testing::from_ascii(rows), 20.0)}; };
  const Features first = seen("#.... #.... ##### ..... .....");
  const Features all = together(first, {{seen("....# ....# ..... ...## ...#."), {}}, {first, {}}}, 1e6);
  EXPECT_EQ(all.left_out, std::vector<std::size_t>{1});
  EXPECT_EQ(all.own_frame, first.map);
  EXPECT_EQ(frame_numbers(all.left_out), std::vector<std::size_t>{2}) << "as answers tell it";
}

TEST(Features, TakeNoTimeWhereTheyWereGiven) {
  const Features given{FeatureMap::centred(seen_in({}, 1.0).map.cells, 2.0)};
  const OtherFeatures other{{FeatureMap::centred(seen_in({}, 2.0).map.cells, 2.0)}, {25.0, 0.0, Angle()}};
  EXPECT_FALSE(together(given, {other}, 1e6).detect_time);
}

}  // namespace
}  // namespace roadfix::api
