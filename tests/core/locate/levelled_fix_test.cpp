#include "core/locate/levelled_fix.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <thread>

#include "core/grid/relief.hpp"
#include "core/grid/resample.hpp"
#include "core/locate/told_frames.hpp"
#include "tests/core/locate/locate_fixture.hpp"
#include "tests/support/random_pose.hpp"
#include "tests/support/sloping_ground.hpp"

namespace roadfix {
namespace {

using testing::observed_at;
using testing::pose_within;

/// Above a town on a slope of a sixth, in whose relief its streets are shown.
class Slopes : public testing::Locate {
 protected:
  Slopes() { view_.terrain = std::make_shared<const Terrain>(ground_.terrain()); }
  double agl_m(const GridPose& truth, double higher_m = 0.0) const {
    return kAboveSeaM + higher_m - ground_.height_m(truth.position);
  }
  Prior around(GridPoint point, double radius_m) const {
    Prior prior;
    prior.circle = GeoCircle{view_.zone.unproject(point), radius_m};
    return prior;
  }
  FeatureMap displaced(const GridPose& truth, double higher_m = 0.0) {
    const FeatureMap ground = observed_at(map_, truth, 260, 260, 2.0, {0.1, 0.1}, random_);
    return shown_in_relief(ground, Relief(*view_.terrain, truth, agl_m(truth, higher_m)), 180, 180);
  }

  static constexpr double kAboveSeaM = 800.0;
  testing::SlopingGround ground_{view_.extent, 200.0, 600.0};
};

TEST_F(Slopes, AreFoundByWhatTheyWouldShowIfTheyWereLevel) {
  for (int i = 0; i < 2; ++i) {
    const GridPose truth = pose_within(view_.extent, 350.0, random_);
    const Prior near = around(truth.position, 150.0);
    const FeatureMap features = displaced(truth);
    const Fix as_shown = locate_levelled(std::nullopt, view_, features, near, {});
    ASSERT_FALSE(as_shown.modes.empty());
    EXPECT_GT(error_m(as_shown.modes[0].pose, truth), 1.5);
    for (const auto above_sea_m : {std::optional<double>(), std::optional(kAboveSeaM)}) {
      const Fix fix = locate_levelled(Altitude{above_sea_m, agl_m(truth)}, view_, features, near, {});
      ASSERT_EQ(fix.status, FixStatus::kFix) << fix.reason << ' ' << fix.explanation;
      EXPECT_LT(error_m(fix.modes[0].pose, truth), above_sea_m ? 5.0 : 1.0) << "a search over sizes has larger steps";
      EXPECT_GT(fix.modes[0].rho, as_shown.modes[0].rho + 0.05);
    }
  }
}

TEST_F(Slopes, AreNoneWhereNothingShowsThem) {
  const GridPose truth = pose_within(view_.extent, 350.0, random_);
  const FeatureMap level = observed_at(map_, truth, 180, 180, 2.0, {0.1, 0.1}, random_);
  ASSERT_EQ(locate_levelled(std::nullopt, view_, level, {}, {}).status, FixStatus::kFix);
  const auto refusal_from = [&](double agl_m) {
    const Fix fix = locate_levelled(Altitude{std::nullopt, agl_m}, view_, level, {}, {});
    EXPECT_LE(fix.probability, 0.5);
    return fix.reason;
  };
  EXPECT_EQ(refusal_from(120.0), "not-above-chance");
  EXPECT_EQ(refusal_from(60.0), "terrain-contradicts") << "the place is not found again";
}

TEST_F(Slopes, TakeTheTimeOfBothSearchesAlsoWhereThePlaceIsNotFoundAgain) {
  const GridPose truth = pose_within(view_.extent, 350.0, random_);
  const FeatureMap level = observed_at(map_, truth, 180, 180, 2.0, {0.1, 0.1}, random_);
  const Altitude altitude{std::nullopt, 60.0};
  const auto slow = 2 * locate_from(altitude, view_, level, {}, {}).search_time;
  std::int64_t furthest = 0;
  FixOptions options;
  options.search.progress = [&](std::int64_t done, std::int64_t) {
    if (done < furthest) std::this_thread::sleep_for(slow);  // the second search begins
    furthest = done;
  };
  const Fix fix = locate_levelled(altitude, view_, level, {}, options);
  EXPECT_EQ(fix.reason, "terrain-contradicts");
  EXPECT_GE(fix.search_time, slow);
}

TEST_F(Slopes, AreNoneWhereTheTimeIsOverBeforeThePlaceIsFoundAgain) {
  const GridPose truth = pose_within(view_.extent, 350.0, random_);
  const FeatureMap level = observed_at(map_, truth, 180, 180, 2.0, {0.1, 0.1}, random_);
  const Altitude altitude{std::nullopt, 60.0};
  const Fix as_shown = locate_from(altitude, view_, level, {}, {});
  ASSERT_EQ(as_shown.status, FixStatus::kFix) << "though levelled it lies elsewhere";
  // The second search begins when the time is over.
  const auto end = std::chrono::steady_clock::now() + 3 * as_shown.search_time + std::chrono::milliseconds(200);
  std::int64_t furthest = 0;
  FixOptions options;
  options.search.deadline = Deadline({}, std::chrono::time_point_cast<std::chrono::steady_clock::duration>(end));
  options.search.progress = [&](std::int64_t done, std::int64_t) {
    if (done < furthest) std::this_thread::sleep_until(end);
    furthest = done;
  };
  const Fix fix = locate_levelled(altitude, view_, level, {}, options);
  EXPECT_EQ(fix.status, FixStatus::kNoFix);
  EXPECT_EQ(fix.reason, "search-time-limit");
  EXPECT_FALSE(fix.complete);
}

TEST_F(Slopes, AreLevelledInEachOfSeveralFramesFromItsOwnHeight) {
  const GridPose truth = pose_within(view_.extent, 450.0, random_);
  const Prior near = around(truth.position, 150.0);
  const Altitude altitude{kAboveSeaM, required_agl_m(view_, search_region(view_, near, {}).box, kAboveSeaM)};
  const auto taken_at = [&](const BodyOffset& offset, double higher_m) -> PlacedFeatures {
    const GridPose pose = moved(truth, offset);
    FeatureMap seen = displaced(pose, higher_m);
    seen.cell_m *= (altitude.agl_m + higher_m) / agl_m(pose, higher_m);
    return {resampled(seen, 2.0), offset, higher_m};
  };
  const std::vector<PlacedFeatures> frames{taken_at({}, 0.0), taken_at({-150.0, 20.0, Angle::degrees(10.0)}, 90.0)};
  const FeatureMap together = laid_together(frames, 1e6).features;
  const FixOptions options{.own_frame = frames[0].features, .others = {frames[1]}};
  const Fix as_shown = locate_from(altitude, view_, together, near, options);
  const Fix fix = locate_levelled(altitude, view_, together, near, options);
  ASSERT_EQ(fix.status, FixStatus::kFix) << fix.reason << ' ' << fix.explanation;
  EXPECT_LT(error_m(fix.modes[0].pose, truth), 1.0);
  EXPECT_GT(error_m(as_shown.modes.at(0).pose, truth), 2.0);
  EXPECT_GT(fix.modes[0].rho, as_shown.modes[0].rho + 0.1);
}

}  // namespace
}  // namespace roadfix
