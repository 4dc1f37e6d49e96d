// What must not change an answer, and does not.
#include <gtest/gtest.h>

#include "tests/core/locate/locate_fixture.hpp"
#include "tests/support/random_pose.hpp"
#include "tests/support/repeats.hpp"

namespace roadfix {
namespace {

using testing::observed_at;
using testing::pose_within;
using testing::repeats;

bool is_same(const GeoPose& a, const GeoPose& b) {
  return a.position.lat_deg == b.position.lat_deg && a.position.lon_deg == b.position.lon_deg &&
         a.heading.radians() == b.heading.radians();
}

using LocateAlike = testing::Locate;

TEST_F(LocateAlike, ACanvasThatWasNotSeenAroundTheFrameChangesNothing) {
  Prior prior;
  for (int i = 0; i < repeats(4); ++i) {
    const GridPose truth = pose_within(view_.extent, 300.0, random_);
    prior.circle = GeoCircle{on_earth(truth, view_.zone).position, 400.0};
    const FeatureMap frame = observed_at(map_, truth, 110, 90, 2.0, {0.3, 0.3}, random_);
    FeatureMap padded = frame;
    padded.cells = CellArray(1200, 1000);
    paste(frame.cells, padded.cells, 700, 300);
    padded.nadir = {frame.nadir.col + 700.0, frame.nadir.row + 300.0};
    const Fix alone = locate(view_, frame, prior, {});
    const Fix within = locate(view_, padded, prior, {});
    EXPECT_EQ(within.status, alone.status);
    EXPECT_EQ(within.probability, alone.probability);
    ASSERT_EQ(within.modes.size(), alone.modes.size());
    for (std::size_t mode = 0; mode < alone.modes.size(); ++mode) {
      EXPECT_TRUE(is_same(within.modes[mode].pose, alone.modes[mode].pose));
    }
  }
}

TEST_F(LocateAlike, IsAsSureHoweverManyPlacesItIsToTell) {
  Prior prior;
  for (int i = 0; i < repeats(4); ++i) {
    const GridPose truth = pose_within(view_.extent, 300.0, random_);
    prior.circle = GeoCircle{on_earth(truth, view_.zone).position, 400.0};
    const FeatureMap frame = observed_at(map_, truth, 80, 80, 2.0, {0.35, 0.35}, random_);
    const Fix usual = locate(view_, frame, prior, {});
    for (const int count : {1, 3, 40}) {
      FixOptions options;
      options.search.max_modes = count;
      const Fix asked = locate(view_, frame, prior, options);
      EXPECT_EQ(asked.status, usual.status) << count;
      EXPECT_EQ(asked.probability, usual.probability) << count;
      EXPECT_LE(asked.modes.size(), static_cast<std::size_t>(count));
      EXPECT_TRUE(is_same(asked.modes.front().pose, usual.modes.front().pose)) << count;
    }
  }
}

TEST_F(LocateAlike, IsAsGoodAsItSaysOfAFrameThatLiesFarFromItsNadir) {
  Prior prior;
  int fixes = 0;
  for (int i = 0; i < repeats(6); ++i) {
    const GridPose truth = pose_within(view_.extent, 700.0, random_);
    prior.circle = GeoCircle{on_earth(truth, view_.zone).position, 300.0};
    const GridPose seen = moved(truth, {450.0, 100.0, {}});
    FeatureMap frame = observed_at(map_, seen, 150, 150, 2.0, {0.15, 0.15}, random_);
    frame.nadir.row += 450.0 / 2.0;
    frame.nadir.col -= 100.0 / 2.0;
    const Fix fix = locate(view_, frame, prior, {});
    if (fix.status != FixStatus::kFix) continue;
    ++fixes;
    const FixMode& mode = fix.modes.front();
    EXPECT_LT(error_m(mode.pose, truth), 4.0 * mode.ellipse.sigma_m[0] + 2.0);
    EXPECT_LT(angular_distance(mode.pose.heading, on_earth(truth, view_.zone).heading).degrees(), 0.5);
  }
  EXPECT_GE(fixes, repeats(6) / 2);
}

}  // namespace
}  // namespace roadfix
