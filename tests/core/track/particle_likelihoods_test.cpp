#include "core/track/particle_likelihoods.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace roadfix {
namespace {

/// Two particles of equal weight; so many cells of the frame lie on ground that the map shows.
class ParticleLikelihoods : public ::testing::Test {
 protected:
  ParticleLikelihoods() {
    particles_.resize(2);
    particles_.weight = {0.5, 0.5};
  }
  static ParticleMatches matches(std::int64_t cells, std::vector<double> scales) {
    const MatchSums sums{cells, 30.0, 25.0, 28.0, 24.0, 20.0};
    return {{sums, sums}, std::move(scales)};
  }

  static FeatureMap frame_with_a_road() {
    CellArray cells(20, 10, kNoRoad);
    for (int col = 0; col < cells.cols(); ++col) cells.at(col, 4) = kRoad;
    return FeatureMap::centred(std::move(cells), 2.0);
  }

  Particles particles_;
  const FeatureMap frame_ = FeatureMap::centred(CellArray(20, 10, kRoad), 2.0);
  const MeasurementModel model_;
};

TEST_F(ParticleLikelihoods, AreThoseOfTheModelAndOfLargerGroundInLargerCells) {
  const ParticleMatches at = matches(200, {1.0, 0.5});
  const auto found = log_likelihoods_of(particles_, at, frame_, model_);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->at(0), model_.log_likelihood(at.sums[0], 200, 2.0));
  EXPECT_EQ(found->at(1), model_.log_likelihood(at.sums[1], 50, 4.0));
}

TEST_F(ParticleLikelihoods, AreNoneWhereTheFrameShowsNoGroundOrTheMapNextToNone) {
  const ParticleMatches on_map = matches(50, {1.0, 1.0});
  EXPECT_TRUE(log_likelihoods_of(particles_, on_map, frame_, model_));
  const FeatureMap blind = FeatureMap::centred(CellArray(20, 10, kUnobserved), 2.0);
  EXPECT_FALSE(log_likelihoods_of(particles_, on_map, blind, model_));
  const ParticleMatches beside = matches(49, {1.0, 1.0});
  EXPECT_FALSE(log_likelihoods_of(particles_, beside, frame_, model_));
  MeasurementModel paper;
  paper.kind = LikelihoodKind::kEquation7;
  EXPECT_TRUE(log_likelihoods_of(particles_, beside, frame_, paper)) << "equation (7) is as it stands";
}

TEST_F(ParticleLikelihoods, KnowAFrameAndGroundWithoutRoads) {
  EXPECT_FALSE(shows_roads(FeatureMap::centred(CellArray(20, 10, kNoRoad), 2.0)));
  EXPECT_TRUE(shows_roads(frame_with_a_road()));
  const MatchSums no_road{200, 0.0, 0.0, 0.0, 0.0, 0.0};
  const ParticleMatches half{{no_road, matches(50, {1.0}).sums[0]}, {1.0, 1.0}};
  EXPECT_EQ(share_with_roads(particles_, half), 0.5);
}

}  // namespace
}  // namespace roadfix
