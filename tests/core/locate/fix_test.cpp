#include "core/locate/fix.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "core/grid/combine.hpp"
#include "core/grid/resample.hpp"
#include "tests/support/code_of.hpp"
#include "tests/support/map_view.hpp"
#include "tests/support/random_pose.hpp"
#include "tests/support/street_map.hpp"

namespace roadfix {
namespace {

using testing::code_of;
using testing::observed_at;
using testing::pose_within;
using testing::street_map;
using testing::view_of;

constexpr double kConvergenceMatters = 0.5;

// Some 100 km east of the central meridian of zone 34, at 57.7 north: convergence is more than a degree.
GridGeometry town(double width_m, double height_m) {
  return {2.0, {300'000, -3'200'000}, static_cast<int>(width_m / 2.0), static_cast<int>(height_m / 2.0)};
}

class Locate : public ::testing::Test {
 protected:
  RoadGrid map_ = street_map(21, town(2400, 1800));
  MapView view_ = view_of(map_);
  std::mt19937_64 random_{22};

  double error_m(const GeoPose& found, const GridPose& truth) const {
    return distance_m(view_.zone.project(found.position), truth.position);
  }
};

TEST_F(Locate, FixesAWindowOfTheMapInTrueHeading) {
  const GridPose truth = pose_within(view_.extent, 300.0, random_);
  ASSERT_GT(std::abs(view_.zone.convergence(truth.position).degrees()), kConvergenceMatters);
  const Fix fix = locate(view_, observed_at(map_, truth, 200, 200, 2.0, {0.2, 0.2}, random_), {}, {});
  ASSERT_EQ(fix.status, FixStatus::kFix) << fix.reason << ' ' << fix.probability;
  EXPECT_GE(fix.probability, 0.99);
  EXPECT_LT(error_m(fix.modes[0].pose, truth), 2.0);
  EXPECT_LT(angular_distance(fix.modes[0].pose.heading, on_earth(truth, view_.zone).heading).degrees(), 0.5);
  EXPECT_EQ(fix.map_name, view_.name);
  EXPECT_NEAR(fix.searched_km2, 2.4 * 1.8, 1e-6);
  EXPECT_GE(fix.modes[0].sigma_m[0], fix.modes[0].sigma_m[1]);
}

TEST_F(Locate, ALonePieceOfRoadIsNoFixThoughItFitsOnePlaceFarBetterThanAllOthers) {
  constexpr int kSide = 100;
  constexpr int kCol = 500;
  constexpr int kRow = 400;
  for (int row = 0; row < kSide; ++row) {
    for (int col = 0; col < kSide; ++col) map_.cells.at(kCol + col, kRow + row) = kNoRoad;
  }
  for (int i = 0; i < 15; ++i) {
    for (int width = 0; width < 3; ++width) {
      map_.cells.at(kCol + 40 + i, kRow + 30 + width) = kRoad;
      map_.cells.at(kCol + 40 + width, kRow + 30 + i) = kRoad;
    }
  }
  const MapView view = view_of(map_);
  const GridPose place{map_.geometry.point_at({kCol + kSide / 2.0, kRow + kSide / 2.0}), {}};
  Prior prior;
  prior.circle = GeoCircle{on_earth(place, view.zone).position, 500.0};
  const Fix fix = locate(view, cut_out(map_, place, kSide, kSide, 2.0), prior, {});
  EXPECT_EQ(fix.status, FixStatus::kNoFix);
  EXPECT_EQ(fix.reason, "too-few-roads");
  EXPECT_LE(fix.probability, 0.5);
  ASSERT_GE(fix.modes.size(), 2U);
  EXPECT_LT(error_m(fix.modes[0].pose, place), 2.0);
  EXPECT_GT(fix.modes[0].rho, 0.95);
  for (const FixMode& mode : fix.modes) EXPECT_TRUE(mode.rho < 0.85 || error_m(mode.pose, place) < 2.0) << mode.rho;
  EXPECT_GT(fix.figures->surprise, 4.6);
}

TEST_F(Locate, SaysTheSameWhateverCellsTheSearchesBeforeItHad) {
  const GridPose truth = pose_within(view_.extent, 300.0, random_);
  Prior prior;
  prior.circle = GeoCircle{on_earth(truth, view_.zone).position, 200.0};
  FixOptions options;
  options.proof_time = std::chrono::minutes(5);
  const FeatureMap features = observed_at(map_, truth, 200, 200, 2.0, {0.2, 0.2}, random_);
  const Fix alone = locate(view_, features, prior, options);
  view_.searches = std::make_shared<SearchCache>(std::size_t{1} << 30);
  locate(view_, resampled(features, 4.0), prior, options);
  const Fix after = locate(view_, features, prior, options);
  EXPECT_EQ(after.figures->lead, alone.figures->lead);
  EXPECT_EQ(after.probability, alone.probability);
  EXPECT_EQ(after.proof->bound, alone.proof->bound);
  EXPECT_EQ(after.proof->excluded_share, alone.proof->excluded_share);
}

TEST_F(Locate, TellsWhatWasProvenWhereAProofIsAskedFor) {
  const GridPose truth = pose_within(view_.extent, 300.0, random_);
  Prior prior;
  prior.circle = GeoCircle{on_earth(truth, view_.zone).position, 100.0};
  FixOptions options;
  const FeatureMap features = observed_at(map_, truth, 150, 150, 2.0, {0.1, 0.1}, random_);
  EXPECT_FALSE(locate(view_, features, prior, options).proof.has_value());
  options.proof_time = std::chrono::minutes(5);
  const Fix fix = locate(view_, features, prior, options);
  ASSERT_TRUE(fix.proof.has_value());
  EXPECT_TRUE(fix.proof->complete);
  EXPECT_LT(error_m(fix.modes.at(0).pose, truth), 2.0);
}

TEST_F(Locate, CountsHowWellTheNadirIsKnownInItsAccuracy) {
  const GridPose truth = pose_within(view_.extent, 300.0, random_);
  FeatureMap features = observed_at(map_, truth, 200, 200, 2.0, {0.1, 0.1}, random_);
  const Fix exact = locate(view_, features, {}, {});
  features.nadir_sigma_m = 7.0;
  const Fix fix = locate(view_, features, {}, {});
  ASSERT_FALSE(fix.modes.empty());
  for (const std::size_t axis : {0U, 1U}) {
    EXPECT_NEAR(fix.modes[0].sigma_m[axis], std::hypot(exact.modes.at(0).sigma_m[axis], 7.0), 1e-9);
  }
  EXPECT_EQ(fix.probability, exact.probability);
}

TEST_F(Locate, TakesFinerCellsThanTheMapHas) {
  const GridPose truth = pose_within(view_.extent, 300.0, random_);
  const Fix fix = locate(view_, cut_out(map_, truth, 600, 600, 0.6), {}, {});
  ASSERT_EQ(fix.status, FixStatus::kFix) << fix.reason;
  EXPECT_LT(error_m(fix.modes[0].pose, truth), 1.0);
}

TEST_F(Locate, ReportsTheNadirWhereverItLiesInTheFeatureMap) {
  const GridPose truth = pose_within(view_.extent, 400.0, random_);
  FeatureMap window = cut_out(map_, truth, 200, 200, 2.0);
  // The camera looks ahead: the UAV is 100 m behind the centre of what it sees.
  window.nadir.row += 50.0;
  const GridPose behind{
      {truth.position.east_m - 100.0 * sin(truth.heading), truth.position.north_m - 100.0 * cos(truth.heading)},
      truth.heading};
  const Fix fix = locate(view_, window, {}, {});
  ASSERT_EQ(fix.status, FixStatus::kFix) << fix.reason;
  EXPECT_LT(error_m(fix.modes[0].pose, behind), 1.0);
}

TEST_F(Locate, WithANarrowPriorIsSureOfSmallerFootprints) {
  const GridPose truth = pose_within(view_.extent, 400.0, random_);
  const GeoPose geo_truth = on_earth(truth, view_.zone);
  Prior prior;
  prior.circle = GeoCircle{geo_truth.position, 60.0};
  prior.heading = HeadingRange{geo_truth.heading, Angle::degrees(15.0)};
  const Fix fix = locate(view_, observed_at(map_, truth, 150, 150, 2.0, {0.1, 0.1}, random_), prior, {});
  ASSERT_EQ(fix.status, FixStatus::kFix) << fix.reason << ' ' << fix.probability;
  EXPECT_LT(error_m(fix.modes[0].pose, truth), 2.0);
}

TEST_F(Locate, WhatIsAFixIsOneForAKnownHeadingToo) {
  for (int round = 0; round < 2; ++round) {
    const GridPose truth = pose_within(view_.extent, 300.0, random_);
    const FeatureMap seen = observed_at(map_, truth, 180, 180, 2.0, {0.4, 0.4}, random_);
    const Fix unknown = locate(view_, seen, {}, {});
    ASSERT_EQ(unknown.status, FixStatus::kFix) << unknown.reason << ' ' << unknown.probability;
    for (const double half_width : {10.0, 60.0}) {
      Prior prior;
      prior.heading = {on_earth(truth, view_.zone).heading + Angle::degrees(0.3 * half_width),
                       Angle::degrees(half_width)};
      const Fix known = locate(view_, seen, prior, {});
      EXPECT_EQ(known.status, FixStatus::kFix) << half_width << ' ' << known.reason << ' ' << known.probability;
    }
  }
}

TEST_F(Locate, SaysNoFixOverAnotherTown) {
  const RoadGrid elsewhere = street_map(77, town(2400, 1800));
  for (int round = 0; round < 2; ++round) {
    const GridPose pose = pose_within(view_.extent, 300.0, random_);
    const Fix fix = locate(view_, cut_out(elsewhere, pose, 160, 160, 2.0), {}, {});
    EXPECT_EQ(fix.status, FixStatus::kNoFix);
    EXPECT_EQ(fix.reason, "not-above-chance") << "roads enough, but others";
    EXPECT_LT(fix.probability, 0.9);
  }
}

TEST_F(Locate, SaysAmbiguousInACityOfEqualBlocks) {
  const RoadGrid city = testing::grid_city(town(1600, 1200), 90.0);
  const MapView view = view_of(city);
  const GridPose truth = pose_within(view.extent, 300.0, random_);
  const Fix fix = locate(view, observed_at(city, truth, 160, 160, 2.0, {0.1, 0.1}, random_), {}, {});
  EXPECT_EQ(fix.status, FixStatus::kAmbiguous) << fix.reason;
  EXPECT_EQ(fix.reason, "several-places-fit");
  EXPECT_LT(fix.probability, 0.5);
  EXPECT_GT(fix.modes.size(), 3U);
}

TEST_F(Locate, SaysWhyAFeatureMapCannotTell) {
  EXPECT_EQ(locate(view_, FeatureMap::centred(CellArray(100, 100, kNoRoad), 2.0), {}, {}).reason, "too-few-roads");
  EXPECT_EQ(locate(view_, FeatureMap::centred(CellArray(100, 100, kRoad), 2.0), {}, {}).reason, "too-few-roads");
  const Fix unseen = locate(view_, FeatureMap::centred(CellArray(100, 100), 2.0), {}, {});
  EXPECT_EQ(unseen.reason, "footprint-unobserved");
  EXPECT_EQ(unseen.status, FixStatus::kNoFix);
  EXPECT_TRUE(unseen.modes.empty());
}

TEST_F(Locate, NeverPlacesAPatchOfGroundAsSmallAsAYard) {
  for (const int side : {1, 4, 5, 10, 20, 29}) {
    const GridPose pose = pose_within(view_.extent, 300.0, random_);
    CellArray cells = cut_out(map_, pose, side, side, 2.0).cells;
    cells.at(0, 0) = kRoad;
    const Fix fix = locate(view_, FeatureMap::centred(std::move(cells), 2.0), {}, {});
    EXPECT_EQ(fix.status, FixStatus::kNoFix) << side;
    EXPECT_EQ(fix.reason, "footprint-too-small") << side;
  }
  CellArray mostly_dark(200, 200);
  paste(cut_out(map_, pose_within(view_.extent, 300.0, random_), 20, 20, 2.0).cells, mostly_dark, 90, 90);
  EXPECT_EQ(locate(view_, FeatureMap::centred(std::move(mostly_dark), 2.0), {}, {}).reason, "footprint-too-small");
  EXPECT_EQ(locate(view_, FeatureMap::centred(CellArray(30, 30, kRoad), 0.01), {}, {}).reason, "footprint-too-small");
}

TEST_F(Locate, SaysThatADeadEndIsTooFewRoadsToTellPlacesApart) {
  CellArray field(160, 160, kNoRoad);
  for (int row = 60; row < 100; ++row) field.at(80, row) = field.at(81, row) = kRoad;
  const Fix fix = locate(view_, FeatureMap::centred(field, 2.0), {}, {});
  EXPECT_EQ(fix.status, FixStatus::kNoFix);
  EXPECT_EQ(fix.reason, "too-few-roads");
  EXPECT_FALSE(fix.modes.empty()) << "it was looked for";
}

TEST_F(Locate, SaysWhenTheMapHoldsNothingThere) {
  RoadGrid bare{map_.geometry, CellArray(map_.geometry.cols, map_.geometry.rows, kNoRoad)};
  const FeatureMap window = cut_out(map_, pose_within(view_.extent, 300.0, random_), 120, 120, 2.0);
  EXPECT_EQ(locate(view_of(bare), window, {}, {}).reason, "map-too-empty");
}

TEST_F(Locate, RefusesWhatItCannotUse) {
  const FeatureMap good = FeatureMap::centred(CellArray(100, 100, kNoRoad), 2.0);
  const auto code = [&](const FeatureMap& features, const Prior& prior = {}, const FixOptions& options = {}) {
    return code_of([&] { locate(view_, features, prior, options); });
  };
  EXPECT_EQ(code(FeatureMap::centred(CellArray(), 2.0)), "feature-map-empty");
  EXPECT_EQ(code(FeatureMap::centred(CellArray(5, 5), 0.0)), "cell-size-out-of-range");
  EXPECT_EQ(code(FeatureMap::centred(CellArray(5, 5), std::nan(""))), "cell-size-out-of-range");
  EXPECT_EQ(code(FeatureMap::centred(CellArray(5, 5), 1e9)), "feature-map-too-large");
  FeatureMap far = good;
  far.nadir.col = 1e12;
  EXPECT_EQ(code(far), "nadir-out-of-range");

  Prior prior;
  prior.circle = GeoCircle{{50.0, 21.0}, 500.0};
  EXPECT_EQ(code(good, prior), "prior-outside-map");
  prior.circle = GeoCircle{{10.0, -100.0}, 500.0};
  EXPECT_EQ(code(good, prior), "position-outside-zone");
  const LatLon here = view_.zone.unproject(view_.extent.min);
  prior.circle = GeoCircle{here, -1.0};
  EXPECT_EQ(code(good, prior), "prior-radius-out-of-range");
  prior.circle = GeoCircle{{std::nan(""), 10.0}, 500.0};
  EXPECT_EQ(code(good, prior), "position-out-of-range");
  prior = {};
  prior.box = GeoBox{{58.0, 18.0}, {57.0, 19.0}};
  EXPECT_EQ(code(good, prior), "prior-box-empty");
  prior = {};
  prior.heading = HeadingRange{Angle::degrees(10.0), Angle::degrees(-5.0)};
  EXPECT_EQ(code(good, prior), "prior-heading-out-of-range");
  prior.heading = HeadingRange{Angle::degrees(1e300), Angle::degrees(5.0)};
  EXPECT_EQ(code(good, prior), "prior-heading-out-of-range");

  FixOptions options;
  options.max_search_km2 = 1.0;
  EXPECT_EQ(code(good, {}, options), "search-area-too-large");
  options = {};
  options.confidence = 1.5;
  EXPECT_EQ(code(good, {}, options), "confidence-out-of-range");
  options = {};
  options.scale_range = 0.31;
  EXPECT_EQ(code(good, {}, options), "scale-range-out-of-range");
  MapView empty = view_;
  empty.extent = {{1.0, 1.0}, {0.0, 0.0}};
  EXPECT_EQ(code_of([&] { locate(empty, good, {}, {}); }), "map-unobserved");
}

TEST_F(Locate, EndsAtItsTimeLimitAndSaysWhatItHas) {
  FixOptions options;
  options.time_limit = std::chrono::milliseconds(1);
  const FeatureMap window = cut_out(map_, pose_within(view_.extent, 300.0, random_), 160, 160, 2.0);
  const Fix fix = locate(view_, window, {}, options);
  EXPECT_EQ(fix.status, FixStatus::kNoFix);
  EXPECT_EQ(fix.reason, "search-time-limit");
  EXPECT_FALSE(fix.complete);
  EXPECT_LT(fix.searched_share, 1.0);
}

TEST_F(Locate, TheEllipseHoldsTheErrors) {
  // Normalised estimation error squared over many fixes, position and heading: 3 on average if the covariance is right.
  // The band is wide on purpose: what is excluded is a covariance that is wrong by its kind.
  double nees = 0.0;
  int fixes = 0;
  for (int round = 0; round < 8; ++round) {
    const GridPose truth = pose_within(view_.extent, 300.0, random_);
    Prior prior;
    prior.circle = GeoCircle{on_earth(truth, view_.zone).position, 100.0};
    const Fix fix = locate(view_, observed_at(map_, truth, 150, 150, 2.0, {0.2, 0.2}, random_), prior, {});
    if (fix.status != FixStatus::kFix) continue;
    ++fixes;
    const FixMode& mode = fix.modes[0];
    const GridPoint at = view_.zone.project(mode.pose.position);
    const double east = at.east_m - truth.position.east_m;
    const double north = at.north_m - truth.position.north_m;
    const Angle major = view_.zone.grid_from_true(mode.ellipse_heading, at);
    const double along = east * sin(major) + north * cos(major);
    const double across = east * cos(major) - north * sin(major);
    const double turn =
        (mode.pose.heading - on_earth(truth, view_.zone).heading).wrapped().radians() / mode.heading_sigma.radians();
    nees += std::pow(along / mode.sigma_m[0], 2) + std::pow(across / mode.sigma_m[1], 2) + turn * turn;
  }
  ASSERT_GT(fixes, 4);
  EXPECT_LT(nees / fixes, 6.0);
  EXPECT_GT(nees / fixes, 0.02);
}

TEST_F(Locate, RefusesFramesThatFitTogetherWhereTheOneThatIsAskedForDoesNot) {
  const GridPose truth = pose_within(view_.extent, 400.0, random_);
  const auto seen_from = [&](double ahead_m) {
    return observed_at(map_, moved(truth, {ahead_m, 0.0, {}}), 100, 100, 2.0, {0.2, 0.2}, random_);
  };
  const FeatureMap own = seen_from(0.0);
  const FeatureMap ahead = seen_from(120.0);
  const FeatureMap far_ahead = seen_from(240.0);
  const auto together = [&](double late_m) {
    const std::vector<PlacedFeatures> parts{
        {own, {}}, {ahead, {120.0 - late_m, 0.0, {}}}, {far_ahead, {240.0 - late_m, 0.0, {}}}};
    return combined(parts, 1e6);
  };
  const auto answer = [&](double late_m, const std::optional<FeatureMap>& own_frame) {
    return locate(view_, together(late_m), {}, {.own_frame = own_frame});
  };
  const Fix right = answer(0.0, own);
  EXPECT_EQ(right.status, FixStatus::kFix) << right.explanation;
  EXPECT_LT(error_m(right.modes.at(0).pose, truth), 4.0);
  const Fix misled = answer(60.0, {});
  ASSERT_EQ(misled.status, FixStatus::kFix);
  ASSERT_GT(error_m(misled.modes.at(0).pose, truth), 50.0);
  const Fix refused = answer(60.0, own);
  EXPECT_EQ(refused.status, FixStatus::kNoFix);
  EXPECT_EQ(refused.reason, "frames-contradict");
  EXPECT_LE(refused.probability, 0.5);
  EXPECT_EQ(refused.modes.at(0).weight, refused.probability);
}

}  // namespace
}  // namespace roadfix
