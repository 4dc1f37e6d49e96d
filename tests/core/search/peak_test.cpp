#include "core/search/peak.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <functional>

#include "core/search/search.hpp"
#include "tests/core/search/seen_town.hpp"

namespace roadfix {
namespace {

using Offset = std::array<double, 3>;
using Square = std::array<std::array<double, 3>, 3>;

PeakScores scores_of(const std::function<double(const Offset&)>& score) {
  PeakScores scores;
  for (int bin = -kPeakRadius; bin <= kPeakRadius; ++bin) {
    for (int row = -kPeakRadius; row <= kPeakRadius; ++row) {
      for (int col = -kPeakRadius; col <= kPeakRadius; ++col) {
        scores.at(col, row, bin) = score({double(col), double(row), double(bin)});
      }
    }
  }
  return scores;
}

/// So many samples that likelihoods fall by many orders of magnitude while scores hardly change.
ScoreBackground sharp() {
  ScoreBackground background;
  background.sd = 0.001;
  return background;
}

/// Scores around 0.5 whose likelihoods are those of a normal distribution.
PeakScores normal(const Offset& centre, const Square& precision) {
  const double per_score = (sharp().log_likelihood(0.5001) - sharp().log_likelihood(0.4999)) / 0.0002;
  return scores_of([&](const Offset& at) {
    double squares = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) squares += (at[i] - centre[i]) * precision[i][j] * (at[j] - centre[j]);
    }
    return 0.5 - 0.5 * squares / per_score;
  });
}

void expect_near(const Square& is, const Square& expected) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(is[i][j], expected[i][j], 0.015) << i << ", " << j;
  }
}

TEST(PeakShape, HasTheTopAndTheCovarianceOfANormalDistribution) {
  const Offset centre{0.3, -0.2, 0.25};
  const Square covariance{{{0.64, 0.0, 0.0}, {0.0, 0.49, 0.0}, {0.0, 0.0, 0.36}}};
  const PeakShape shape =
      shape_of(normal(centre, {{{1 / 0.64, 0.0, 0.0}, {0.0, 1 / 0.49, 0.0}, {0.0, 0.0, 1 / 0.36}}}), sharp());
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(shape.offset[i], centre[i], 1e-3) << i;
  expect_near(shape.covariance, covariance);
}

TEST(PeakShape, TellsWhatGoesTogether) {
  // Inverse of each other: [a b; b a] and [a -b; -b a] / (a^2 - b^2).
  const double a = 0.5;
  const double b = 0.3;
  const double det = a * a - b * b;
  const PeakShape columns_and_bins =
      shape_of(normal({}, {{{a / det, 0.0, -b / det}, {0.0, 2.0, 0.0}, {-b / det, 0.0, a / det}}}), sharp());
  expect_near(columns_and_bins.covariance, {{{a, 0.0, b}, {0.0, 0.5, 0.0}, {b, 0.0, a}}});
}

TEST(PeakShape, HasItsTopWhereAHillThatLeansOverAllAxesHasIt) {
  const Offset top{0.3, -0.2, 0.25};
  for (const double leaning : {0.0, 0.3, -0.5}) {
    const PeakShape shape = shape_of(scores_of([&](const Offset& at) {
                                       const double x = at[0] - top[0];
                                       const double y = at[1] - top[1];
                                       const double z = at[2] - top[2];
                                       return 0.8 - 0.01 * (x * x + y * y + z * z + 2.0 * leaning * (x * y - y * z));
                                     }),
                                     sharp());
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(shape.offset[i], top[i], 1e-3) << i << " leaning " << leaning;
  }
}

TEST(PeakShape, HasItsTopNoFartherThanHalfAStepAway) {
  for (const double slope : {0.01, -0.01}) {
    const PeakShape shape = shape_of(
        scores_of([&](const Offset& at) { return 0.5 + slope * (at[0] + at[1] + at[2]) - 1e-4 * at[0] * at[0]; }),
        sharp());
    EXPECT_EQ(shape.offset[0], slope > 0.0 ? 0.5 : -0.5);
  }
  EXPECT_EQ(shape_of(scores_of([](const Offset&) { return 0.5; }), sharp()).offset, Offset{}) << "all alike";
}

TEST(PeakScores, AreThoseOfEachPoseAround) {
  const testing::SeenTown town(1, 400, 300, 200.0, 100, 80);
  const SearchLevels levels = town.levels();
  const Level& finest = levels.finest();
  const LatticePose pose{lattice_index(town.region.box.centre(), finest.cell_m()), 7};
  const PeakScores scores = peak_around(finest, finest.bins, pose).scores;
  EXPECT_NE(scores.at(0, 0, 0), 0.0);
  for (const int col : {-kPeakRadius, 1, kPeakRadius}) {
    for (const int row : {-kPeakRadius, -2, kPeakRadius}) {
      for (const int bin : {-kPeakRadius, 2, kPeakRadius}) {
        const LatticePose there{{pose.cell.col + col, pose.cell.row + row}, pose.bin + bin};
        EXPECT_EQ(scores.at(col, row, bin), peak_around(finest, finest.bins, there).scores.at(0, 0, 0));
      }
    }
  }
}

TEST(PeakScores, HaveTheirHighestAnywhereAroundOrElseInTheMiddle) {
  EXPECT_EQ(highest(scores_of([](const Offset&) { return 0.5; })), (std::array{0, 0, 0}));
  for (const int col : {-kPeakRadius, 0, kPeakRadius}) {
    for (const int row : {-kPeakRadius, 0, kPeakRadius}) {
      for (const int bin : {-kPeakRadius, 1, kPeakRadius}) {
        PeakScores scores;
        scores.at(col, row, bin) = 0.1;
        EXPECT_EQ(highest(scores), (std::array{col, row, bin}));
      }
    }
  }
}

}  // namespace
}  // namespace roadfix
