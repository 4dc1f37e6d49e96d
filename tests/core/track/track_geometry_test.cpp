#include "core/track/track_geometry.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/filter/cholesky.hpp"
#include "tests/support/map_view.hpp"

namespace roadfix {
namespace {

/// Of a vector on the grid.
struct Direction {
  double east = 0.0;
  double north = 0.0;
};

/// 100 km east of the zone's central meridian, where true north and that of the grid are more than a degree apart.
class TrackGeometry : public ::testing::Test {
 protected:
  /// From where a step to the north comes out on the plane.
  Direction on_plane(Angle true_heading) const {
    LatLon at = view_.zone.unproject(place_);
    at.lat_deg += 1e-4;
    const GridPoint north = view_.zone.project(at);
    const Angle of_north = Angle::radians(std::atan2(north.east_m - place_.east_m, north.north_m - place_.north_m));
    return {sin(of_north + true_heading), cos(of_north + true_heading)};
  }
  static Direction on_plane_from_grid(Angle heading) { return {sin(heading), cos(heading)}; }
  static void expect_same(Direction a, Direction b) {
    EXPECT_NEAR(a.east, b.east, 1e-5);
    EXPECT_NEAR(a.north, b.north, 1e-5);
  }

  const RoadGrid map_{{2.0, {300'000, -3'200'000}, 800, 700}, CellArray(800, 700)};
  const GridPoint place_{600'700.0, 6'399'400.0};
  MapView view_ = testing::view_of(map_);
};

TEST_F(TrackGeometry, ProposesPlacesAroundTheEllipsesOfAFixAsTheyLieOnTheGrid) {
  FixMode mode;
  mode.pose = on_earth({place_, Angle::degrees(60.0)}, view_.zone);
  mode.scale = 1.1;
  mode.weight = 0.7;
  mode.ellipse.sigma_m = {20.0, 2.0};
  mode.ellipse.heading = Angle::degrees(40.0);
  mode.heading_sigma = Angle::degrees(2.0);
  Fix fix;
  fix.modes = {mode};
  const auto proposals = proposals_of(view_, fix, FeatureMap::centred(CellArray(100, 100, kNoRoad), 2.0));
  ASSERT_EQ(proposals.size(), 1U);
  const Proposal& place = proposals.front();
  EXPECT_LT(distance_m(place.mean.position, place_), 1e-3);
  EXPECT_NEAR(place.mean.heading.degrees(), 60.0, 1e-6);
  EXPECT_EQ(place.weight, 0.7);
  EXPECT_NEAR(place.log_scale, std::log(1.1), 1e-12);

  const Direction along = on_plane(mode.ellipse.heading);
  const Direction across{along.north, -along.east};
  const auto covariance = [&](Direction a, Direction b) {
    const PoseCovariance& c = place.covariance;
    return a.east * (c[0][0] * b.east + c[0][1] * b.north) + a.north * (c[1][0] * b.east + c[1][1] * b.north);
  };
  constexpr double kWider = 9.0;
  EXPECT_GT(covariance(along, along), 20.0 * 20.0);
  EXPECT_LT(covariance(along, along), kWider * 20.0 * 20.0);
  EXPECT_GT(covariance(across, across), 2.0 * 2.0);
  EXPECT_LT(covariance(across, across), kWider * 2.0 * 2.0);
  EXPECT_NEAR(covariance(along, across), 0.0, 0.1);
  const double sigma = std::sqrt(place.covariance[2][2]);
  EXPECT_GT(Angle::radians(sigma).degrees(), 2.0);
  EXPECT_LT(Angle::radians(sigma).degrees(), 3.0 * 2.0);
}

TEST_F(TrackGeometry, ProposesPlacesAMetreAndHalfADegreeAroundAFixHoweverSureItIs) {
  FixMode mode;
  mode.pose = on_earth({place_, Angle::degrees(60.0)}, view_.zone);
  Fix fix;
  fix.modes = {mode};
  const auto proposals = proposals_of(view_, fix, FeatureMap::centred(CellArray(100, 100, kNoRoad), 2.0));
  const PoseCovariance& covariance = proposals.at(0).covariance;
  EXPECT_TRUE(cholesky(covariance)) << "particles are drawn by it";
  EXPECT_NEAR(covariance[0][0], 1.0, 1e-9);
  EXPECT_NEAR(covariance[1][1], 1.0, 1e-9);
  EXPECT_NEAR(Angle::radians(std::sqrt(covariance[2][2])).degrees(), 0.5, 0.1);
}

TEST_F(TrackGeometry, TellsAClusterOnTheEarthWithTheErrorsOfMapAndNadirInTheSizeThatTheGroundHas) {
  view_.registration_sigma_m = [](GridPoint) { return 5.0; };
  Cluster cluster;
  cluster.mean = {place_, Angle::degrees(60.0)};
  cluster.weight = 0.8;
  const double turn = Angle::degrees(3.0).radians();
  cluster.covariance = {{{900.0, 0.0, 0.0}, {0.0, 100.0, 0.0}, {0.0, 0.0, turn * turn}}};
  cluster.radius95_m = 60.0;
  cluster.log_scale = 0.1;
  cluster.log_scale_sigma = 0.02;
  const TrackCluster told = to_geographic(view_, cluster, 12.0 / std::exp(0.1));
  expect_same(on_plane(told.pose.heading), on_plane_from_grid(cluster.mean.heading));
  expect_same(on_plane(told.ellipse.heading), on_plane_from_grid(Angle::degrees(90.0)));
  EXPECT_NEAR(told.ellipse.sigma_m[0], std::sqrt(900.0 + 25.0 + 144.0), 1e-9);
  EXPECT_NEAR(told.ellipse.sigma_m[1], std::sqrt(100.0 + 25.0 + 144.0), 1e-9);
  EXPECT_NEAR(told.heading_sigma.degrees(), 3.0, 1e-9);
  const double told95_m = std::sqrt(-2.0 * std::log(0.05)) * std::hypot(5.0, 12.0);
  EXPECT_NEAR(told.radius95_m, std::hypot(60.0, told95_m), 1e-3);
  EXPECT_NEAR(told.scale, std::exp(0.1), 1e-12);
  EXPECT_NEAR(told.scale_sigma, (std::exp(0.12) - std::exp(0.08)) / 2.0, 1e-4);
}

TEST_F(TrackGeometry, TellsTheCircleOfNinetyFivePercentWithTheErrorOfTheMapsRegistrationToo) {
  Cluster cluster;
  cluster.mean.position = place_;
  cluster.covariance = {{{9.0, 0.0, 0.0}, {0.0, 9.0, 0.0}, {}}};
  cluster.radius95_m = kSigmasOf95 * 3.0;
  view_.registration_sigma_m = [](GridPoint) { return 0.0; };
  EXPECT_NEAR(to_geographic(view_, cluster, 0.0).radius95_m, kSigmasOf95 * 3.0, 1e-9);
  view_.registration_sigma_m = [](GridPoint) { return 4.0; };
  const TrackCluster told = to_geographic(view_, cluster, 0.0);
  EXPECT_NEAR(told.ellipse.sigma_m[0], 5.0, 1e-9);
  EXPECT_NEAR(told.radius95_m, kSigmasOf95 * 5.0, 1e-9);
}

TEST_F(TrackGeometry, TellsTheErrorOfTheNadirOnBothAxes) {
  view_.registration_sigma_m = [](GridPoint) { return 0.0; };
  Cluster cluster;
  cluster.mean.position = place_;
  cluster.covariance = {{{81.0, 0.0, 0.0}, {0.0, 25.0, 0.0}, {}}};
  cluster.radius95_m = kSigmasOf95 * 9.0;
  const TrackCluster told = to_geographic(view_, cluster, 12.0);
  EXPECT_NEAR(told.ellipse.sigma_m[0], 15.0, 1e-9);
  EXPECT_NEAR(told.ellipse.sigma_m[1], 13.0, 1e-9);
  EXPECT_NEAR(told.radius95_m, kSigmasOf95 * 15.0, 1e-9);
}

TEST_F(TrackGeometry, GivesTheHeadingsNearAPoseAsTheyAreOnTheEarth) {
  const auto prior = prior_near(view_, {place_, Angle::degrees(60.0)}, 80.0, Angle::degrees(15.0));
  ASSERT_TRUE(prior && prior->heading && prior->circle);
  expect_same(on_plane(prior->heading->centre), on_plane_from_grid(Angle::degrees(60.0)));
  EXPECT_NEAR(prior->heading->half_width.degrees(), 15.0, 1e-9);
  EXPECT_LT(distance_m(view_.zone.project(prior->circle->centre), place_), 1e-3);
  EXPECT_FALSE(prior_near(view_, {{place_.east_m + 5'000.0, place_.north_m}, Angle()}, 80.0, Angle::degrees(15.0)));
}

TEST_F(TrackGeometry, LooksAroundAllParticlesWithWeight) {
  Particles particles;
  const auto add = [&](double east_m, double north_m, double weight) {
    particles.resize(particles.size() + 1);
    particles.set(particles.size() - 1, {place_.east_m + east_m, place_.north_m + north_m, 0.0});
    particles.weight.back() = weight;
  };
  for (const double east_m : {-300.0, 10.0, 200.0}) {
    for (const double north_m : {-50.0, 90.0}) add(east_m, north_m, 1.0 / 6.0);
  }
  const auto prior = prior_around(view_, particles);
  ASSERT_TRUE(prior && prior->circle);
  const GridPoint centre = view_.zone.project(prior->circle->centre);
  EXPECT_NEAR(prior->circle->radius_m, std::hypot(250.0, 70.0), 2.0) << "and none larger";
  for (std::size_t i = 0; i < particles.size(); ++i) {
    EXPECT_LE(distance_m(centre, {particles.east_m[i], particles.north_m[i]}), prior->circle->radius_m);
  }
  add(5'000.0, 0.0, 0.0);
  EXPECT_EQ(prior_around(view_, particles).value().circle->radius_m, prior->circle->radius_m) << "one has left";
}

}  // namespace
}  // namespace roadfix
