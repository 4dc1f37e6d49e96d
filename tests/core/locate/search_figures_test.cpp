#include "core/locate/search_figures.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace roadfix {
namespace {

/// A best place of `score` among rivals of which Fisher's z thins out exponentially above `lowest`.
SearchResult found_among(double score, double lowest, double mean_excess, int rivals = 200) {
  SearchResult result;
  result.background.sd = 0.05;
  for (int i = 0; i < rivals; ++i) {
    // Quantiles of the exponential tail, highest first.
    const double excess = -mean_excess * std::log((i + 0.5) / rivals);
    result.background.rivals.push_back(std::tanh(std::atanh(lowest) + excess));
  }
  result.background.rivals_within = result.background.rivals;
  SearchMode best;
  best.score = score;
  result.modes = {best};
  if (rivals > 0) {
    best.score = result.background.rivals.front();
    result.modes.push_back(best);
  }
  return result;
}

TEST(SearchFigures, CountsHowManyPlacesChanceWouldPutThere) {
  // An exponential tail of 200 places: exp(-5) of them lie five mean excesses above the lowest.
  const SearchFigures figures = figures_of(found_among(std::tanh(std::atanh(0.2) + 5 * 0.02), 0.2, 0.02));
  EXPECT_NEAR(figures.surprise, 5.0 - std::log(200.0), 0.2);
}

TEST(SearchFigures, LeavesMoreToChanceWhereFewRivalsTellHowTheyThinOut) {
  // If the mean m of n excesses is all that is known of an exponential, one beyond x has the probability E[exp(-x/m)]
  // over the sums n m that a gamma distribution of shape n draws: (1 + x / (n m))^-n.
  constexpr int kExcesses = 12;
  constexpr double kMean = 0.02;
  SearchResult result = found_among(std::tanh(std::atanh(0.1) + 40 * kMean), 0.1, kMean, 1);
  result.background.rivals.clear();
  for (int i = kExcesses; i >= 0; --i) {
    result.background.rivals.push_back(std::tanh(std::atanh(0.1) + 2.0 * kMean * i / (kExcesses + 1)));
  }
  EXPECT_NEAR(figures_of(result).surprise, 12.0 * std::log(52.0 / 12.0) - std::log(12.0), 1e-9);
}

TEST(SearchFigures, MeasuresTheLeadInDeviationsAndInMeanExcesses) {
  SearchResult result = found_among(0.6, 0.2, 0.02);
  const double ahead = std::atanh(0.6) - std::atanh(result.modes[1].score);
  const SearchFigures figures = figures_of(result);
  EXPECT_NEAR(figures.lead, ahead / 0.05, 1e-9);
  EXPECT_NEAR(figures.gap, ahead / 0.02, 0.05 * ahead / 0.02);
}

TEST(SearchFigures, CountsTheAgreementInDeviationsOfSamplesOfFifteenMetres) {
  SearchResult result = found_among(0.6, 0.2, 0.02);
  result.cell_m = 2.0;
  result.modes[0].pearson = 0.5;
  result.modes[0].observed_cells = 22'500;  // 90,000 m2, 400 samples
  EXPECT_NEAR(figures_of(result).agreement, 0.5 * 20.0, 1e-9);
  EXPECT_NEAR(figures_of(result).ground, std::log(20.0 * 20.0 * 15.0 * 15.0), 1e-9);
}

TEST(SearchFigures, CountsOtherRoadsInRoadsAcrossTheGroundThatTookPart) {
  SearchResult result = found_among(0.6, 0.2, 0.02);
  result.cell_m = 2.0;
  result.modes[0].observed_cells = 22'500;  // 300 x 300 m
  result.other_roads_m = 2 * 300;
  EXPECT_NEAR(figures_of(result).other_roads_across.value(), 2.0, 1e-9);
}

TEST(SearchFigures, ShareTooFewRoadsBelowTheLeastAndWhereTheyAreUnknownOrNoNumber) {
  SearchFigures figures;
  EXPECT_TRUE(shares_too_few_roads(figures));
  for (const double few : {0.0, 0.39, std::nan("")}) {
    figures.other_roads_across = few;
    EXPECT_TRUE(shares_too_few_roads(figures)) << few;
  }
  figures.other_roads_across = kMinOtherRoadsAcross;
  EXPECT_FALSE(shares_too_few_roads(figures));
}

TEST(SearchFigures, ASmallerRegionLeavesChanceLessRoom) {
  SearchResult result = found_among(0.4, 0.2, 0.02);
  const double whole = figures_of(result).surprise;
  result.background.region_share = 0.01;
  EXPECT_NEAR(figures_of(result).surprise - whole, std::log(100.0), 1e-9);
}

TEST(SearchFigures, WithFewRivalsChanceMayExplainEverything) {
  const SearchFigures figures = figures_of(found_among(0.9, 0.2, 0.02, 5));
  EXPECT_LT(figures.surprise, -5.0);
  EXPECT_EQ(figures.gap, 0.0);
}

TEST(SearchFigures, APlaceAloneInItsRegionIsComparedWithThoseAround) {
  SearchResult result = found_among(0.6, 0.2, 0.02);
  result.modes.resize(1);
  result.background.rivals_within.clear();
  EXPECT_NEAR(figures_of(result).lead, (std::atanh(0.6) - std::atanh(result.background.rivals.back())) / 0.05, 1e-9);
}

TEST(SearchFigures, OfAConstantBackgroundIsNone) {
  SearchResult result = found_among(0.6, 0.2, 0.0);
  result.background.sd = 0.0;
  const SearchFigures figures = figures_of(result);
  EXPECT_LT(figures.surprise, 0.0);
  EXPECT_EQ(figures.lead, 0.0);
}

}  // namespace
}  // namespace roadfix
