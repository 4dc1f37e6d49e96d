#include "core/filter/clusters.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/filter/random.hpp"

namespace roadfix {
namespace {

struct Blob {
  double east_m, north_m, heading_deg, sigma_m, sigma_deg, weight;
};

Particles particles_of(const std::vector<Blob>& blobs, int each) {
  Particles p;
  p.resize(blobs.size() * static_cast<std::size_t>(each));
  std::size_t i = 0;
  for (const Blob& blob : blobs) {
    for (int k = 0; k < each; ++k, ++i) {
      RandomStream random(Draw::kStart, {5, 0, i});
      const Angle heading = Angle::degrees(blob.heading_deg + blob.sigma_deg * random.normal());
      p.set(i, {blob.east_m + blob.sigma_m * random.normal(), blob.north_m + blob.sigma_m * random.normal(),
                heading.wrapped().radians()});
      p.weight[i] = blob.weight / each;
    }
  }
  return p;
}

TEST(Clusters, SeparatePlacesAndHeadingsHeaviestFirst) {
  const Particles particles =
      particles_of({{0, 0, 90, 5, 2, 0.2}, {500, 0, 90, 5, 2, 0.5}, {0, 0, -90, 5, 2, 0.3}}, 2000);
  const auto clusters = clusters_of(particles);
  ASSERT_EQ(clusters.size(), 3U);
  EXPECT_NEAR(clusters[0].weight, 0.5, 1e-9);
  EXPECT_NEAR(clusters[0].mean.position.east_m, 500.0, 0.6);
  EXPECT_NEAR(clusters[1].mean.heading.degrees(), -90.0, 0.3);
  EXPECT_NEAR(clusters[2].weight, 0.2, 1e-9);
  const Cluster heaviest = heaviest_of(particles);
  EXPECT_EQ(heaviest.mean.position, clusters[0].mean.position);
  EXPECT_EQ(heaviest.covariance, clusters[0].covariance);
  EXPECT_EQ(heaviest.weight, clusters[0].weight);
}

TEST(Clusters, AreThoseOfTheirParticlesAloneWhateverTheirShareOfTheWeight) {
  const Blob heavier{3000, 7000, 40, 8, 3, 0.7};
  const Blob lighter{4000, 6000, 80, 3, 5, 0.3};
  Particles both = particles_of({heavier, lighter}, 500);
  for (std::size_t i = 0; i < both.size(); ++i) both.log_scale[i] = 1e-4 * static_cast<double>(i);
  const auto clusters = clusters_of(both);
  ASSERT_EQ(clusters.size(), 2U);
  for (const std::size_t of : {0U, 1U}) {
    Particles alone = both;
    for (std::size_t i = 0; i < both.size(); ++i) alone.weight[i] = i / 500 == of ? 1.0 / 500.0 : 0.0;
    const Cluster expected = heaviest_of(alone);
    const Cluster& cluster = clusters[of];
    EXPECT_NEAR(distance_m(cluster.mean.position, expected.mean.position), 0.0, 1e-6);
    EXPECT_NEAR(cluster.mean.heading.degrees(), expected.mean.heading.degrees(), 1e-9);
    EXPECT_NEAR(cluster.sigma_m(), expected.sigma_m(), 1e-6);
    EXPECT_NEAR(cluster.covariance[2][2], expected.covariance[2][2], 1e-9);
    EXPECT_NEAR(cluster.radius95_m, expected.radius95_m, 1e-6);
    EXPECT_NEAR(cluster.log_scale, expected.log_scale, 1e-9);
    EXPECT_NEAR(cluster.log_scale_sigma, expected.log_scale_sigma, 1e-9);
  }
  EXPECT_NEAR(clusters[1].mean.position.north_m, 6000.0, 1.0);
}

TEST(Clusters, GoRoundSouth) {
  const auto clusters = clusters_of(particles_of({{0, 0, 179.0, 3, 8, 1.0}}, 3000));
  ASSERT_EQ(clusters.size(), 1U);
  EXPECT_NEAR(std::abs(clusters[0].mean.heading.degrees()), 179.0, 1.5);
  EXPECT_NEAR(Angle::radians(std::sqrt(clusters[0].covariance[2][2])).degrees(), 8.0, 0.6);
}

TEST(Clusters, TellSpreadAndThe95PercentRadius) {
  const auto clusters = clusters_of(particles_of({{1e6, 4e6, 0, 6, 1, 1.0}}, 20'000));
  ASSERT_EQ(clusters.size(), 1U);
  EXPECT_NEAR(clusters[0].sigma_m(), 6.0, 0.2);
  EXPECT_NEAR(clusters[0].radius95_m, 6.0 * std::sqrt(5.991), 0.4) << "chi-square of two degrees of freedom";
}

TEST(Clusters, TellTheSpreadAlongTheLongerAxisHoweverItLies) {
  constexpr int kReach = 60;
  for (const double direction : {0.0, 30.0, 45.0, 90.0, 135.0}) {
    Particles p;
    p.resize(2 * kReach + 1);
    for (int along = -kReach; along <= kReach; ++along) {
      const Angle towards = Angle::degrees(direction);
      const auto i = static_cast<std::size_t>(along + kReach);
      p.set(i, {along * sin(towards), along * cos(towards), 0.0});
      p.weight[i] = 1.0 / (2 * kReach + 1);
    }
    const auto clusters = clusters_of(p);
    ASSERT_EQ(clusters.size(), 1U) << direction;
    EXPECT_NEAR(clusters[0].sigma_m(), std::sqrt(kReach * (kReach + 1) / 3.0), 1e-9) << direction;
  }
}

TEST(Clusters, TellTheirScale) {
  Particles p = particles_of({{0, 0, 0, 5, 1, 0.25}, {0, 0, 0, 5, 1, 0.75}}, 100);
  std::fill(p.log_scale.begin() + 100, p.log_scale.end(), 0.1);
  const auto clusters = clusters_of(p);
  ASSERT_EQ(clusters.size(), 1U);
  EXPECT_NEAR(clusters[0].log_scale, 0.075, 1e-12);
  EXPECT_NEAR(clusters[0].log_scale_sigma, 0.1 * std::sqrt(0.25 * 0.75), 1e-12);
}

TEST(Clusters, HoldTogetherWhatLiesInSquaresOf20MetresThatTouch) {
  const auto count = [](double apart_m) {
    return clusters_of(particles_of({{1, 1, 0, 0, 0, 0.5}, {1 + apart_m, 1, 0, 0, 0, 0.5}}, 1)).size();
  };
  EXPECT_EQ(count(38.0), 1U);
  EXPECT_EQ(count(40.0), 2U);
}

TEST(Clusters, WeighNoMoreThanAllThoughTheSumRounds) {
  Particles p;
  p.resize(9);
  std::ranges::fill(p.weight, 1.0 / 9.0);
  EXPECT_EQ(heaviest_of(p).weight, 1.0);
}

TEST(Clusters, LeaveOutWhatHasNoWeight) {
  const auto clusters = clusters_of(particles_of({{0, 0, 0, 5, 1, 1.0}, {900, 0, 0, 5, 1, 0.0}}, 100));
  EXPECT_EQ(clusters.size(), 1U);
}

}  // namespace
}  // namespace roadfix
