#include "core/locate/altitude.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "tests/core/locate/locate_fixture.hpp"
#include "tests/support/code_of.hpp"
#include "tests/support/random_pose.hpp"
#include "tests/support/sloping_ground.hpp"

namespace roadfix {
namespace {

using testing::code_of;
using testing::observed_at;
using testing::pose_within;

/// Above a town that rises by 60 m from west to east, from 200 m above the sea.
class Altitudes : public testing::Locate {
 protected:
  Altitudes() { view_.terrain = std::make_shared<const Terrain>(ground_.terrain()); }

  FeatureMap seen(const GridPose& truth, const Altitude& altitude) {
    return ground_.taken_for(observed_at(map_, truth, 200, 200, 2.0, {0.1, 0.1}, random_), truth.position, altitude);
  }
  static Prior around(const MapView& map, GridPoint point, double radius_m) {
    Prior prior;
    prior.circle = GeoCircle{map.zone.unproject(point), radius_m};
    return prior;
  }

  testing::SlopingGround ground_{view_.extent};
  const double above_sea_m_ = 430.0;
  const Altitude altitude_{above_sea_m_, 200.0};
};

TEST_F(Altitudes, FixAWindowInTheSizeThatTheGroundBelowGives) {
  for (const double east_share : {0.2, 0.8}) {
    GridPose truth = pose_within(view_.extent, 300.0, random_);
    truth.position.east_m = view_.extent.min.east_m + east_share * view_.extent.width_m();
    const FeatureMap features = seen(truth, altitude_);
    const Fix fix = locate_from(altitude_, view_, features, {}, {.own_frame = features});
    EXPECT_GE(fix.probability, 0.9) << fix.reason << ' ' << fix.explanation;
    ASSERT_FALSE(fix.modes.empty());
    EXPECT_LT(error_m(fix.modes[0].pose, truth), 3.0);
    EXPECT_NEAR(fix.modes[0].agl_m.value(), 230.0 - 60.0 * east_share, 0.5);
    EXPECT_NEAR(fix.modes[0].scale, 1.0, 0.02) << "as the ground there says";
    EXPECT_NE(locate(view_, features, {}, {}).status, FixStatus::kFix) << "in the size that was assumed";
  }
}

TEST_F(Altitudes, SearchNoSizesWhereTheGroundSaysWhichItIs) {
  const GridPose truth = pose_within(view_.extent, 400.0, random_);
  const FeatureMap features = seen(truth, altitude_);
  const Fix fix = locate_from(altitude_, view_, features, around(view_, truth.position, 50.0), {});
  EXPECT_EQ(fix.scales, 1);
  EXPECT_GT(locate_from(altitude_, view_, features, {}, {}).scales, 1);
  ASSERT_FALSE(fix.modes.empty());
  EXPECT_LT(error_m(fix.modes[0].pose, truth), 3.0);
}

/// Who takes the vehicle to be 30 m higher than it is.
class WrongAltitudes : public Altitudes {
 protected:
  const Altitude wrong_{above_sea_m_ + 30.0, 230.0};
  const GridPose truth_{{view_.extent.min.east_m + 400.0, view_.extent.centre().north_m}, Angle::degrees(100.0)};
  const FeatureMap features_ = ground_.taken_for(observed_at(map_, truth_, 200, 200, 2.0, {0.1, 0.1}, random_),
                                                 truth_.position, {above_sea_m_, wrong_.agl_m});
};

TEST_F(WrongAltitudes, RefuseAPlaceThatShowsItsRoadsInAnotherSizeThanItShould) {
  const Fix fix = locate_from(wrong_, view_, features_, {}, {});
  ASSERT_FALSE(fix.modes.empty());
  EXPECT_LT(error_m(fix.modes[0].pose, truth_), 20.0);
  EXPECT_EQ(fix.status, FixStatus::kNoFix);
  EXPECT_EQ(fix.reason, "terrain-contradicts") << fix.explanation;
  EXPECT_LE(fix.probability, 0.5);
}

TEST_F(WrongAltitudes, AreMendedWithinARangeOfSizesThatIsTold) {
  const Fix fix =
      locate_from(wrong_, view_, features_, around(view_, truth_.position, 200.0), {.search = {.scale_range = 0.2}});
  ASSERT_EQ(fix.status, FixStatus::kFix) << fix.reason << ' ' << fix.explanation;
  EXPECT_LT(error_m(fix.modes[0].pose, truth_), 5.0);
  EXPECT_NEAR(fix.modes[0].scale, 220.0 / 250.0, 0.02) << "the ground is smaller than the altitude says";
}

TEST_F(Altitudes, GiveNoFixWhereTheHeightMayBeAnything) {
  const GridPose truth = pose_within(view_.extent, 300.0, random_);
  const Altitude low{290.0, 60.0};
  const Fix fix = locate_from(low, view_, seen(truth, low), {}, {});
  EXPECT_EQ(fix.reason, "height-unknown");
  EXPECT_NE(fix.explanation.find("30 to 9"), std::string::npos) << fix.explanation;

  view_.terrain = nullptr;
  EXPECT_EQ(locate_from(altitude_, view_, seen(truth, altitude_), {}, {}).reason, "height-unknown");
}

TEST_F(Altitudes, GiveNoFixWhereTheGroundOfThePlaceIsUnknown) {
  const GridPose truth = pose_within(view_.extent, 400.0, random_);
  auto holed = std::make_shared<Terrain>(ground_.terrain());
  const auto at = holed->geometry.position_of(truth.position);
  for (int row = static_cast<int>(at.row) - 3; row <= static_cast<int>(at.row) + 3; ++row) {
    for (int col = static_cast<int>(at.col) - 3; col <= static_cast<int>(at.col) + 3; ++col) {
      holed->codes[static_cast<std::size_t>(row * holed->geometry.cols + col)] = Terrain::kUnknown;
    }
  }
  view_.terrain = holed;
  const Fix fix = locate_from(altitude_, view_, seen(truth, altitude_), {}, {});
  EXPECT_EQ(fix.reason, "terrain-contradicts") << fix.explanation;
}

TEST_F(Altitudes, AreRefusedBelowTheGroundAndWhereTheMapKnowsNone) {
  const AglRange agl = agl_above(view_, view_.extent, 430.0).value();
  EXPECT_NEAR(agl.lowest_m, 170.0, 1.5);
  EXPECT_NEAR(agl.highest_m, 230.0, 1.5);
  EXPECT_NEAR(required_agl_m(view_, view_.extent, 430.0), std::sqrt(170.0 * 230.0), 1.0);
  EXPECT_EQ(code_of([&] { required_agl_m(view_, view_.extent, 150.0); }), "below-ground");
  view_.terrain = nullptr;
  EXPECT_EQ(code_of([&] { required_agl_m(view_, view_.extent, 430.0); }), "terrain-missing");
}

}  // namespace
}  // namespace roadfix
