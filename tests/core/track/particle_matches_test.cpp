#include "core/track/particle_matches.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "core/grid/resample.hpp"
#include "core/units/draws.hpp"
#include "tests/support/flight.hpp"
#include "tests/support/map_view.hpp"

namespace roadfix {
namespace {

TEST(ParticleMatches, AreThoseOfEquation5AtTheirPoses) {
  const RoadGrid map = testing::street_map(51, {2.0, {300'000, -3'200'000}, 800, 700});
  const GridPose middle{{600'700.0, 6'399'400.0}, Angle::degrees(60.0)};
  std::mt19937_64 random(11);
  const FeatureMap features = testing::observed_at(map, middle, 100, 90, 2.0, {0.1, 0.1}, random);
  Particles p;
  p.resize(300);
  for (std::size_t i = 0; i < p.size(); ++i) {
    p.set(i, {middle.position.east_m + uniform(random, -20, 20), middle.position.north_m + uniform(random, -20, 20),
              middle.heading.radians() + uniform(random, -0.1, 0.1)});
    p.weight[i] = i == 7 ? 0.0 : 1.0;
  }
  const auto sums = match_particles(testing::view_of(map), features, p).sums;
  EXPECT_EQ(sums[7].n, 0);
  double difference = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (i == 7) continue;
    // Brute force: the map cut out at the very pose.
    const FeatureMap below = cut_out(map, p.at(i).pose(), 100, 90, 2.0);
    MatchSums exact;
    for (int r = 0; r < 90; ++r) {
      for (int c = 0; c < 100; ++c) {
        if (!is_observed(below.cells.at(c, r))) continue;
        exact.add(probability(below.cells.at(c, r)), probability(features.cells.at(c, r)));
      }
    }
    difference += std::abs(*rho(sums[i]) - *rho(exact)) / 299.0;
  }
  EXPECT_LT(difference, 0.05) << "nearest cell and shared heading bins";
}

TEST(ParticleMatches, FitBestAtTheirHeadingInEveryQuarterOfTheCompass) {
  const RoadGrid map = testing::street_map(51, {2.0, {300'000, -3'200'000}, 800, 700});
  std::mt19937_64 random(12);
  for (const double heading : {25.0, 115.0, 205.0, 295.0}) {
    const GridPose pose{{600'701.0, 6'399'399.0}, Angle::degrees(heading)};
    const FeatureMap features = testing::observed_at(map, pose, 100, 90, 2.0, {0.0, 0.0}, random);
    Particles p;
    p.resize(4);
    for (std::size_t i = 0; i < p.size(); ++i) {
      const Angle turned = pose.heading + Angle::degrees(90.0 * static_cast<double>(i));
      p.set(i, {pose.position.east_m, pose.position.north_m, turned.radians()});
      p.weight[i] = 1.0;
    }
    const auto sums = match_particles(testing::view_of(map), features, p).sums;
    EXPECT_GT(*rho(sums[0]), 0.8) << heading;
    for (std::size_t i = 1; i < 4; ++i) EXPECT_LT(*rho(sums[i]), 0.4) << heading << ' ' << i;
  }
}

TEST(ParticleMatches, FitBestAtTheSizeThatTheGroundHas) {
  const RoadGrid map = testing::street_map(51, {2.0, {300'000, -3'200'000}, 800, 700});
  std::mt19937_64 random(14);
  const GridPose pose{{600'701.0, 6'399'399.0}, Angle::degrees(40.0)};
  FeatureMap features = testing::observed_at(map, pose, 120, 120, 2.0, {0.0, 0.0}, random);
  features.cell_m = 2.0 / 1.1;  // taken from higher than was thought
  features = resampled(features, 2.0);
  Particles p;
  p.resize(5);
  for (std::size_t i = 0; i < p.size(); ++i) {
    p.set(i, {pose.position.east_m, pose.position.north_m, pose.heading.radians()});
    p.log_scale[i] = std::log(1.1) * (static_cast<double>(i) - 2.0);
    p.weight[i] = 1.0;
  }
  const ParticleMatches matches = match_particles(testing::view_of(map), features, p, 0.2);
  EXPECT_GT(*rho(matches.sums[3]), 0.7);
  for (const std::size_t i : {0U, 1U, 2U, 4U}) EXPECT_LT(*rho(matches.sums[i]), 0.5) << i;
  // A bin is at most two cells wide at the edge, 85 cells from the nadir.
  for (std::size_t i = 0; i < p.size(); ++i) EXPECT_NEAR(std::log(matches.scales[i]), p.log_scale[i], 1.0 / 77.0) << i;
  EXPECT_NEAR(static_cast<double>(matches.sums[3].n), 1.21 * static_cast<double>(matches.sums[2].n), 300.0);
}

TEST(ParticleMatches, AreTheSameToTheLastBitForManyAtOnceAndForEachAlone) {
  // Many share a map that is turned with them; one alone has its own feature map turned.
  const RoadGrid map = testing::street_map(52, {2.0, {300'000, -3'200'000}, 150, 130});
  std::mt19937_64 random(13);
  const GridBox box = map.geometry.box();
  const GridPose middle{map.geometry.cell_center(75, 65), Angle::degrees(80.0)};
  const FeatureMap features = testing::observed_at(map, middle, 40, 50, 2.0, {0.1, 0.1}, random);
  Particles all;
  all.resize(400);
  for (std::size_t i = 0; i < all.size(); ++i) {
    all.set(i, {uniform(random, box.min.east_m - 20.0, box.max.east_m + 20.0),
                uniform(random, box.min.north_m - 20.0, box.max.north_m + 20.0),
                uniform(random, -std::numbers::pi, std::numbers::pi)});
    all.weight[i] = 1.0;
  }
  const MapView view = testing::view_of(map);
  const auto together = match_particles(view, features, all).sums;
  for (std::size_t i = 0; i < all.size(); ++i) {
    Particles one;
    one.resize(1);
    one.set(0, all.at(i));
    one.weight[0] = 1.0;
    const MatchSums alone = match_particles(view, features, one).sums[0];
    EXPECT_EQ(together[i].n, alone.n);
    EXPECT_EQ(together[i].m, alone.m);
    EXPECT_EQ(together[i].ll, alone.ll);
    EXPECT_EQ(together[i].ml, alone.ml);
  }
}

}  // namespace
}  // namespace roadfix
