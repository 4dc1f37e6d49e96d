#include "core/grid/combine.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "core/grid/log_odds.hpp"
#include "core/grid/resample.hpp"
#include "core/units/draws.hpp"
#include "core/units/error.hpp"
#include "tests/support/ascii_map.hpp"
#include "tests/support/code_of.hpp"
#include "tests/support/random_cells.hpp"
#include "tests/support/street_map.hpp"

namespace roadfix {
namespace {

using testing::from_ascii;
using testing::to_ascii;

constexpr double kPlenty = 1e6;

FeatureMap map_of(const char* rows, double cell_m = 2.0) { return FeatureMap::centred(from_ascii(rows), cell_m); }

TEST(Combined, OneFrameStaysAsItIs) {
  const FeatureMap map = map_of("#.? .#. ?.#");
  const PlacedFeatures alone{map, {}};
  const FeatureMap result = combined({&alone, 1}, kPlenty);
  EXPECT_EQ(to_ascii(result.cells), to_ascii(map.cells));
  EXPECT_EQ(result.nadir.col, 1.5);
  EXPECT_EQ(result.nadir.row, 1.5);
}

TEST(Combined, KnowsTheNadirAsWellAsTheLeastKnownOfItsFrames) {
  PlacedFeatures exact{FeatureMap::centred(CellArray(2, 2, kRoad), 1.0), {}};
  PlacedFeatures tilted = exact;
  tilted.features.nadir_sigma_m = 7.0;
  EXPECT_EQ(combined(std::vector{tilted, exact}, 1e3).nadir_sigma_m, 7.0);
  EXPECT_EQ(combined(std::vector{exact, tilted}, 1e3).nadir_sigma_m, 7.0) << "which may be what tells the place";
}

TEST(Combined, KnowsTheHeadingAsWellAsTheLeastKnownOfItsFrames) {
  PlacedFeatures leaning{FeatureMap::centred(CellArray(2, 2, kRoad), 1.0), {}};
  PlacedFeatures high = leaning;
  leaning.features.nadir_heading_sigma = Angle::degrees(0.6);
  high.features.nadir_sigma_m = 7.0;
  EXPECT_EQ(combined(std::vector{high, leaning}, 1e3).nadir_heading_sigma, Angle::degrees(0.6));
  EXPECT_EQ(combined(std::vector{leaning, high}, 1e3).nadir_heading_sigma, Angle::degrees(0.6));
}

TEST(Combined, AFrameFromAheadExtendsTheReferenceForward) {
  const PlacedFeatures parts[] = {{map_of("#.. #.. #.."), {}}, {map_of("### ... ..."), {4.0, 0.0, {}}}};
  const FeatureMap result = combined(parts, kPlenty);
  EXPECT_EQ(to_ascii(result.cells), "###\n...\n5..\n#..\n#..\n");
  EXPECT_EQ(result.nadir.row, 3.5);
}

TEST(Combined, AFrameTurnedRightPutsItsForwardEdgeToTheRight) {
  const PlacedFeatures parts[] = {{map_of("... ... ..."), {}}, {map_of("### ... ..."), {0.0, 6.0, Angle::degrees(90)}}};
  EXPECT_EQ(to_ascii(combined(parts, kPlenty).cells), ".....#\n.....#\n.....#\n");
}

TEST(Combined, KeepsAllThatATurnedFrameSawFarAheadOfItsNadir) {
  FeatureMap ahead = map_of("# . . .");
  ahead.nadir.row = 3.5;  // in the middle of the nearest cell
  const PlacedFeatures parts[] = {{map_of("."), {}}, {ahead, {0.0, 0.0, Angle::degrees(90)}}};
  EXPECT_EQ(to_ascii(combined(parts, kPlenty).cells), "...#\n");
}

TEST(Combined, WhatNoFrameSawStaysUnobserved) {
  const PlacedFeatures parts[] = {{map_of("#? .."), {}}, {map_of(".? ?#"), {4.0, 4.0, {}}}};
  EXPECT_EQ(to_ascii(combined(parts, kPlenty).cells), "??.?\n???#\n#???\n..??\n");
}

TEST(Combined, TakesTheMeanOfTheLogOddsWhereFramesOverlap) {
  FeatureMap sure{CellArray(1, 1, cell_from_probability(0.9)), 2.0, {0.5, 0.5}};
  FeatureMap unsure{CellArray(1, 1, cell_from_probability(0.5)), 2.0, {0.5, 0.5}};
  const PlacedFeatures parts[] = {{sure, {}}, {unsure, {}}};
  const double odds = std::sqrt(9.0);
  EXPECT_NEAR(probability(combined(parts, kPlenty).cells.at(0, 0)), odds / (1.0 + odds), 0.01);
}

TEST(Combined, EachCellIsOfAllFramesThatShowItHoweverTheyLie) {
  std::mt19937_64 random(5);
  std::vector<PlacedFeatures> parts;
  for (int i = 0; i < 8; ++i) {
    const BodyOffset offset{uniform(random, -30.0, 30.0), uniform(random, -30.0, 30.0),
                            Angle::degrees(uniform(random, -180.0, 180.0))};
    parts.push_back({FeatureMap::centred(testing::random_cells(random, 6 + i, 9, 0.2), 2.0), offset});
  }
  const FeatureMap result = combined(parts, kPlenty);
  for (int row = 0; row < result.cells.rows(); ++row) {
    for (int col = 0; col < result.cells.cols(); ++col) {
      double sum = 0.0;
      int frames = 0;
      for (const PlacedFeatures& part : parts) {
        const Placement placement = placement_in(part, result.nadir);
        const Cell cell = bilinear(part.features.cells, placement.source_of(col + 0.5, row + 0.5));
        if (!is_observed(cell)) continue;
        sum += log_odds(cell);
        ++frames;
      }
      const Cell expected = frames > 0 ? cell_from_log_odds(sum / frames) : kUnobserved;
      EXPECT_EQ(is_observed(result.cells.at(col, row)), is_observed(expected)) << col << ' ' << row;
      EXPECT_NEAR(result.cells.at(col, row), expected, 1) << col << ' ' << row;
    }
  }
}

TEST(Combined, FramesCutFromAMapAlongAFlightGiveTheMapBack) {
  const RoadGrid town = testing::street_map(3, {2.0, {1000, 2000}, 200, 200});
  const GridPose reference{town.geometry.box().centre(), Angle::degrees(33)};
  std::vector<PlacedFeatures> parts;
  for (const BodyOffset offset : {BodyOffset{}, BodyOffset{-30.0, 12.0, Angle::degrees(-20)}}) {
    parts.push_back({cut_out(town, moved(reference, offset), 60, 60, town.geometry.cell_m), offset});
  }
  const FeatureMap result = combined(parts, kPlenty);
  EXPECT_GT(result.cells.observed_count(), 3600U);
  // Two frames resampled once more each: cells at the edge of a street may differ, the streets may not.
  const FeatureMap truth = cut_out(town, reference, 61, 61, town.geometry.cell_m);
  double difference = 0.0;
  int count = 0;
  for (int row = -30; row < 30; ++row) {
    for (int col = -30; col < 30; ++col) {
      const Cell ours = result.cells.get(static_cast<int>(std::floor(result.nadir.col)) + col,
                                         static_cast<int>(std::floor(result.nadir.row)) + row);
      const Cell theirs = truth.cells.get(30 + col, 30 + row);
      if (!is_observed(ours) || !is_observed(theirs)) continue;
      difference += std::abs(probability(ours) - probability(theirs));
      ++count;
    }
  }
  EXPECT_GT(count, 3000);
  EXPECT_LT(difference / count, 0.08);
}

TEST(Combined, RefusesFramesThatWouldNeedMoreCellsThanAllowed) {
  const PlacedFeatures parts[] = {{map_of("#. .."), {}}, {map_of("#. .."), {1e5, 1e5, {}}}};
  try {
    combined(parts, 1e6);
    FAIL() << "50,000 x 50,000 cells";
  } catch (const LimitExceeded& error) {
    EXPECT_EQ(error.code(), "frames-too-far-apart");
  }
}

TEST(Combined, RefusesFramesInCellsOfAnotherSize) {
  const auto code = [](double cell_m) {
    const PlacedFeatures parts[] = {{map_of("#. .."), {}}, {map_of("#. ..", cell_m), {}}};
    return testing::code_of([&] { combined(parts, kPlenty); });
  };
  EXPECT_EQ(code(2.1), "cell-size-contradictory");
  EXPECT_EQ(code(2.0 + 1e-9), "no error") << "what came through a text";
}

}  // namespace
}  // namespace roadfix
