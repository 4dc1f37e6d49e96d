// Where nothing can be trusted, and why.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/grid/combine.hpp"
#include "core/grid/resample.hpp"
#include "core/locate/match_poses.hpp"
#include "tests/core/locate/locate_fixture.hpp"
#include "tests/support/code_of.hpp"
#include "tests/support/random_pose.hpp"

namespace roadfix {
namespace {

using testing::code_of;
using testing::observed_at;
using testing::pose_within;
using testing::street_map;
using testing::town;
using testing::view_of;

using NoFix = testing::Locate;

TEST_F(NoFix, ALonePieceOfRoadIsNoFixThoughItFitsOnePlaceFarBetterThanAllOthers) {
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

/// Roads of 8 m from a junction on through 2.4 x 1.8 km of empty ground, towards these headings.
RoadGrid country_with_a_junction(const std::vector<double>& headings_deg) {
  const GridGeometry geometry = town(2400, 1800);
  RoadGrid map{geometry, CellArray(geometry.cols, geometry.rows, kNoRoad)};
  for (int row = 0; row < geometry.rows; ++row) {
    for (int col = 0; col < geometry.cols; ++col) {
      const double east_m = geometry.cell_m * (col - 0.5 * geometry.cols);
      const double north_m = geometry.cell_m * (0.5 * geometry.rows - row);
      for (const double heading_deg : headings_deg) {
        const double heading = Angle::degrees(heading_deg).radians();
        const double along_m = east_m * std::sin(heading) + north_m * std::cos(heading);
        const double beside_m = std::abs(east_m * std::cos(heading) - north_m * std::sin(heading));
        if (along_m >= 0.0 && beside_m <= 4.0) map.cells.at(col, row) = kRoad;
      }
    }
  }
  return map;
}

TEST_F(NoFix, TakesNoJunctionForAnother) {
  const std::vector<std::vector<double>> junctions{
      {10.0, 190.0, 95.0}, {10.0, 95.0, 190.0, 275.0}, {10.0, 130.0, 250.0}};  // T, X, Y
  for (const std::vector<double>& headings : junctions) {
    const RoadGrid country = country_with_a_junction(headings);
    std::vector<double> others = headings;
    others.back() += 3.0;
    const RoadGrid elsewhere = country_with_a_junction(others);
    const MapView view = view_of(country);
    const GridPose pose{view.extent.centre(), Angle::degrees(40.0)};
    const Fix fix = locate(view, observed_at(elsewhere, pose, 200, 200, 2.0, {0.1, 0.1}, random_), {}, {});
    EXPECT_EQ(fix.status, FixStatus::kNoFix) << headings.size();
    EXPECT_EQ(fix.reason, "not-above-chance") << headings.size();
    EXPECT_LE(fix.probability, 0.5) << headings.size();
  }
}

TEST_F(NoFix, SaysNoFixOverAnotherTown) {
  const RoadGrid elsewhere = street_map(77, town(2400, 1800));
  for (int round = 0; round < 2; ++round) {
    const GridPose pose = pose_within(view_.extent, 300.0, random_);
    const Fix fix = locate(view_, cut_out(elsewhere, pose, 160, 160, 2.0), {}, {});
    EXPECT_EQ(fix.status, FixStatus::kNoFix);
    EXPECT_EQ(fix.reason, "not-above-chance") << "roads enough, but others";
    EXPECT_LT(fix.probability, 0.9);
  }
}

TEST_F(NoFix, SaysAmbiguousInACityOfEqualBlocks) {
  const RoadGrid city = testing::grid_city(town(1600, 1200), 90.0);
  const MapView view = view_of(city);
  const GridPose truth = pose_within(view.extent, 300.0, random_);
  const Fix fix = locate(view, observed_at(city, truth, 160, 160, 2.0, {0.1, 0.1}, random_), {}, {});
  EXPECT_EQ(fix.status, FixStatus::kAmbiguous) << fix.reason;
  EXPECT_EQ(fix.reason, "several-places-fit");
  EXPECT_LT(fix.probability, 0.5);
  EXPECT_GT(fix.modes.size(), 3U);
}

TEST_F(NoFix, SaysWhyAFeatureMapCannotTell) {
  EXPECT_EQ(locate(view_, FeatureMap::centred(CellArray(100, 100, kNoRoad), 2.0), {}, {}).reason, "too-few-roads");
  EXPECT_EQ(locate(view_, FeatureMap::centred(CellArray(100, 100, kRoad), 2.0), {}, {}).reason, "too-few-roads");
  const Fix unseen = locate(view_, FeatureMap::centred(CellArray(100, 100), 2.0), {}, {});
  EXPECT_EQ(unseen.reason, "footprint-unobserved");
  EXPECT_EQ(unseen.status, FixStatus::kNoFix);
  EXPECT_TRUE(unseen.modes.empty());
}

TEST_F(NoFix, NeverPlacesAPatchOfGroundAsSmallAsAYard) {
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

TEST_F(NoFix, SearchesForNothingThatIsStrewnFarAroundTheUav) {
  const CellArray seen = cut_out(map_, pose_within(view_.extent, 300.0, random_), 100, 100, 2.0).cells;
  CellArray strewn(100, 3000);
  paste(seen, strewn, 0, 0);
  EXPECT_NE(locate(view_, FeatureMap{strewn, 2.0, {50.0, 50.0}}, {}, {}).reason, "footprint-too-small")
      << "where nothing was observed does not count";
  paste(seen, strewn, 0, 2900);
  const Fix fix = locate(view_, FeatureMap{strewn, 2.0, {50.0, 50.0}}, {}, {});
  EXPECT_EQ(fix.reason, "footprint-too-small");
  EXPECT_THAT(fix.explanation, ::testing::HasSubstr("up to 5901 m"));
  CellArray to_the_right(3000, 100);
  paste(seen, to_the_right, 0, 0);
  paste(seen, to_the_right, 2900, 0);
  EXPECT_THAT(locate(view_, FeatureMap{to_the_right, 2.0, {50.0, 50.0}}, {}, {}).explanation,
              ::testing::HasSubstr("up to 5901 m"));
}

TEST_F(NoFix, SaysThatADeadEndIsTooFewRoadsToTellPlacesApart) {
  CellArray field(160, 160, kNoRoad);
  for (int row = 60; row < 100; ++row) field.at(80, row) = field.at(81, row) = kRoad;
  const Fix fix = locate(view_, FeatureMap::centred(field, 2.0), {}, {});
  EXPECT_EQ(fix.status, FixStatus::kNoFix);
  EXPECT_EQ(fix.reason, "too-few-roads");
  EXPECT_FALSE(fix.modes.empty()) << "it was looked for";
}

TEST_F(NoFix, SaysWhenTheMapHoldsNothingThere) {
  RoadGrid bare{map_.geometry, CellArray(map_.geometry.cols, map_.geometry.rows, kNoRoad)};
  const FeatureMap window = cut_out(map_, pose_within(view_.extent, 300.0, random_), 120, 120, 2.0);
  EXPECT_EQ(locate(view_of(bare), window, {}, {}).reason, "map-too-empty");
}

TEST_F(NoFix, RefusesWhatItCannotUse) {
  const FeatureMap good = FeatureMap::centred(CellArray(100, 100, kNoRoad), 2.0);
  const auto code = [&](const FeatureMap& features, const Prior& prior = {}, const FixOptions& options = {}) {
    return code_of([&] { locate(view_, features, prior, options); });
  };
  EXPECT_EQ(code(FeatureMap::centred(CellArray(), 2.0)), "feature-map-empty");
  EXPECT_EQ(code(FeatureMap::centred(CellArray(5, 5), 0.0)), "parameter-out-of-range");
  EXPECT_EQ(code(FeatureMap::centred(CellArray(5, 5), std::nan(""))), "parameter-out-of-range");
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
  EXPECT_EQ(code(good, prior), "parameter-out-of-range");
  prior.circle = GeoCircle{{std::nan(""), 10.0}, 500.0};
  EXPECT_EQ(code(good, prior), "parameter-out-of-range");
  prior = {};
  prior.box = GeoBox{{58.0, 18.0}, {57.0, 19.0}};
  EXPECT_EQ(code(good, prior), "parameter-out-of-range");
  prior = {};
  prior.heading = HeadingRange{Angle::degrees(10.0), Angle::degrees(-5.0)};
  EXPECT_EQ(code(good, prior), "parameter-out-of-range");
  prior.heading = HeadingRange{Angle::degrees(1e300), Angle::degrees(5.0)};
  EXPECT_EQ(code(good, prior), "parameter-out-of-range");

  FixOptions options;
  options.max_search_km2 = 1.0;
  EXPECT_EQ(code(good, {}, options), "search-area-too-large");
  options = {};
  options.confidence = 1.5;
  EXPECT_EQ(code(good, {}, options), "parameter-out-of-range");
  options = {};
  options.search.scale_range = 0.31;
  EXPECT_EQ(code(good, {}, options), "parameter-out-of-range");
  MapView empty = view_;
  empty.extent = {{1.0, 1.0}, {0.0, 0.0}};
  EXPECT_EQ(code_of([&] { locate(empty, good, {}, {}); }), "map-unobserved");
}

TEST_F(NoFix, EndsAtItsTimeLimitAndSaysWhatItHas) {
  FixOptions options;
  options.search.deadline = Deadline().within(std::chrono::milliseconds(1));
  const FeatureMap window = cut_out(map_, pose_within(view_.extent, 300.0, random_), 160, 160, 2.0);
  const Fix fix = locate(view_, window, {}, options);
  EXPECT_EQ(fix.status, FixStatus::kNoFix);
  EXPECT_EQ(fix.reason, "search-time-limit");
  EXPECT_FALSE(fix.complete);
  EXPECT_LT(fix.searched_share, 1.0);
}

TEST_F(NoFix, RefusesFramesThatFitTogetherWhereTheOneThatIsAskedForDoesNot) {
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
  const auto answer = [&](double late_m, const std::optional<FeatureMap>& own_frame, double confidence = 0.99) {
    return locate(view_, together(late_m), {}, {.confidence = confidence, .own_frame = own_frame});
  };
  const Fix right = answer(0.0, own);
  EXPECT_EQ(right.status, FixStatus::kFix) << right.explanation;
  EXPECT_LT(error_m(right.modes.at(0).pose, truth), 4.0);
  const Fix misled = answer(60.0, {});
  ASSERT_EQ(misled.status, FixStatus::kFix);
  ASSERT_GT(error_m(misled.modes.at(0).pose, truth), 50.0);
  const double beyond_calibration = 0.9999;
  ASSERT_EQ(answer(60.0, {}, beyond_calibration).status, FixStatus::kAmbiguous);
  for (const double confidence : {0.99, beyond_calibration}) {
    const Fix refused = answer(60.0, own, confidence);
    EXPECT_EQ(refused.status, FixStatus::kNoFix);
    EXPECT_EQ(refused.reason, "frames-contradict");
    EXPECT_LE(refused.probability, 0.5);
    EXPECT_EQ(refused.modes.at(0).weight, refused.probability);
  }
}

TEST_F(NoFix, RefusesFramesThatFitTogetherBesideThePlaceOfTheOneThatIsAskedFor) {
  random_.seed(53);
  const GridPose truth = pose_within(view_.extent, 400.0, random_);
  const FeatureMap own = observed_at(map_, truth, 90, 90, 2.0, {0.2, 0.2}, random_);
  const FeatureMap ahead = observed_at(map_, moved(truth, {120.0, 0.0, {}}), 110, 110, 2.0, {0.2, 0.2}, random_);
  const auto answer = [&](double told_ahead_m, const std::optional<FeatureMap>& own_frame) {
    const std::vector<PlacedFeatures> parts{{own, {}}, {ahead, {told_ahead_m, 0.0, {}}}};
    return locate(view_, combined(parts, 1e6), {}, {.own_frame = own_frame});
  };
  EXPECT_EQ(answer(120.0, own).status, FixStatus::kFix);
  const Fix misled = answer(102.0, {});
  ASSERT_EQ(misled.status, FixStatus::kFix);
  const FixMode& place = misled.modes.at(0);
  ASSERT_GT(error_m(place.pose, truth), 8.0 * place.ellipse.sigma_m[0]);
  ASSERT_GT(rho_at(view_, own, on_grid(place.pose, view_.zone)), 0.55 * place.rho) << "along a road, more than half";
  const Fix refused = answer(102.0, own);
  EXPECT_EQ(refused.status, FixStatus::kNoFix);
  EXPECT_EQ(refused.reason, "frames-contradict");
}

TEST_F(NoFix, IsAnsweredWhereTheOthersContradictTheFrameThatIsAskedFor) {
  const GridPose truth = pose_within(view_.extent, 400.0, random_);
  const FeatureMap others = observed_at(map_, truth, 160, 160, 2.0, {0.2, 0.2}, random_);
  const FeatureMap bare = FeatureMap::centred(CellArray(100, 100, kNoRoad), 2.0);
  ASSERT_EQ(locate(view_, others, {}, {.own_frame = bare, .left_out = {1}}).status, FixStatus::kFix);
  const Fix refused = locate(view_, others, {}, {.own_frame = bare, .left_out = {0}});
  EXPECT_EQ(refused.status, FixStatus::kNoFix);
  EXPECT_EQ(refused.reason, "frames-contradict");
  EXPECT_LT(error_m(refused.modes.at(0).pose, truth), 4.0) << "as a hint";
}

TEST_F(NoFix, RefusesAFrameOfWhichAHalfIsOlderThanTheOther) {
  const auto lower_half_of = [](const FeatureMap& from, FeatureMap frame) {
    for (int row = frame.cells.rows() / 2; row < frame.cells.rows(); ++row) {
      std::ranges::copy(from.cells.row(row), frame.cells.row(row).begin());
    }
    return frame;
  };
  int refused = 0;
  for (int i = 0; i < 6; ++i) {
    const GridPose truth = pose_within(view_.extent, 400.0, random_);
    const auto seen_from = [&](double ahead_m) {
      return observed_at(map_, moved(truth, {ahead_m, 0.0, {}}), 160, 160, 2.0, {0.1, 0.1}, random_);
    };
    const FeatureMap frame = seen_from(0.0);
    if (locate(view_, frame, {}, {}).status != FixStatus::kFix) continue;
    const Fix torn = locate(view_, lower_half_of(seen_from(-80.0), frame), {}, {});
    EXPECT_NE(torn.status, FixStatus::kFix) << "off by " << error_m(torn.modes.at(0).pose, truth);
    if (torn.reason != "halves-contradict") continue;
    ++refused;
    EXPECT_EQ(torn.status, FixStatus::kNoFix);
    EXPECT_LE(torn.probability, 0.5);
    EXPECT_EQ(torn.modes.at(0).weight, torn.probability);
  }
  EXPECT_GT(refused, 0) << "each of the others fits nowhere beyond chance";
}

}  // namespace
}  // namespace roadfix
