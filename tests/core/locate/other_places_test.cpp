#include "core/locate/other_places.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/map_view.hpp"

namespace roadfix {
namespace {

/// A search with a best place known to 1 m (1 sigma per axis), on a map that is registered to so many metres.
class OtherPlaces : public ::testing::Test {
 protected:
  static SearchMode mode(double east_m, double score, double heading_deg = 0.0) {
    SearchMode mode;
    mode.pose = {{300'000.0 + east_m, 6'399'400.0}, Angle::degrees(heading_deg)};
    mode.score = score;
    mode.covariance[0][0] = mode.covariance[1][1] = 1.0;
    return mode;
  }
  static SearchResult found() {
    SearchResult result;
    result.modes = {mode(0.0, 0.8), mode(500.0, 0.4)};
    result.background.rivals_within = {0.4, 0.3};
    return result;
  }
  struct Errors {
    double registration_m = 0.0;
    double nadir_m = 0.0;
    double position_sigma_scale = 1.0;
    double scale = 1.0;  ///< of the best place
  };
  void sort_out(SearchResult& found, const Errors& errors) const {
    MapView view = testing::view_of(map_);
    view.registration_sigma_m = [=](GridPoint) { return errors.registration_m; };
    Calibration calibration;
    calibration.position_sigma_scale = errors.position_sigma_scale;
    sort_out_other_places(view, calibration, errors.nadir_m, found);
  }
  /// In whatever direction it lies.
  bool counts_nearby(double away_m, const Errors& errors) const {
    const bool counts = counts_nearby_towards(Angle(), away_m, errors);
    for (const double direction : {45.0, 90.0, 200.0}) {
      EXPECT_EQ(counts_nearby_towards(Angle::degrees(direction), away_m, errors), counts) << direction;
    }
    return counts;
  }
  bool counts_nearby_towards(Angle direction, double away_m, const Errors& errors) const {
    SearchResult result = found();
    result.modes.front().scale = errors.scale;
    result.nearby = mode(away_m * sin(direction), 0.6);
    result.nearby->pose.position.north_m += away_m * cos(direction);
    sort_out(result, errors);
    const bool counts = result.modes.size() == 3;
    EXPECT_EQ(result.modes.at(1).score, counts ? 0.6 : 0.4);
    EXPECT_EQ(result.background.rivals_within.front(), counts ? 0.6 : 0.4);
    return counts;
  }

  const RoadGrid map_{{2.0, {300'000, -3'200'000}, 8, 8}, CellArray(8, 8)};
};

TEST_F(OtherPlaces, LieBeyondFourStandardDeviationsOrFartherThanOnePlaceIsWide) {
  EXPECT_FALSE(counts_nearby(3.9, {}));
  EXPECT_TRUE(counts_nearby(4.1, {}));
  EXPECT_FALSE(counts_nearby(24.0, {10.0}));
  EXPECT_TRUE(counts_nearby(26.0, {10.0}));
}

TEST_F(OtherPlaces, LieBeyondFourStandardDeviationsOfThePositionAsItIsTold) {
  const Errors errors{.registration_m = 0.0, .nadir_m = 3.0, .position_sigma_scale = 2.0};
  const double sigma_m = std::hypot(2.0 * 1.0, 3.0);
  EXPECT_FALSE(counts_nearby(4.0 * sigma_m - 0.1, errors));
  EXPECT_TRUE(counts_nearby(4.0 * sigma_m + 0.1, errors));
  const double larger_m = std::hypot(1.0, 1.2 * 4.0);
  EXPECT_FALSE(counts_nearby(4.0 * larger_m - 0.1, {.nadir_m = 4.0, .scale = 1.2}));
  EXPECT_TRUE(counts_nearby(4.0 * larger_m + 0.1, {.nadir_m = 4.0, .scale = 1.2}));
}

TEST_F(OtherPlaces, OfThoseOutsideTheRegionOnlyTheBestOneItselfIsLeftOut) {
  SearchResult result = found();
  result.outside = {mode(5.0, 0.85), mode(6.0, 0.7), mode(0.0, 0.6, 180.0)};
  sort_out(result, {10.0});
  ASSERT_EQ(result.outside.size(), 2U);
  EXPECT_EQ(result.outside[0].score, 0.7) << "the registration errs for both alike";
  EXPECT_EQ(result.outside[1].score, 0.6) << "at another heading";
}

TEST_F(OtherPlaces, OfASearchThatFoundNoneAreNone) {
  SearchResult result;
  sort_out(result, {2.5});
  EXPECT_TRUE(result.modes.empty());
}

}  // namespace
}  // namespace roadfix
