#include "core/geodesy/local_projection.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "core/units/error.hpp"

namespace roadfix {
namespace {

double between(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

TEST(LocalProjection, StaysWithinItsErrorAllOverTheZones) {
  std::mt19937_64 random(1);
  double worst_m = 0.0;
  double worst_rad = 0.0;
  int tested = 0;
  for (int round = 0; round < 300; ++round) {
    const bool north = round % 2 == 0;
    const double lat = between(random, 0.0, 84.0 - LocalProjection::kSideDeg);
    const UtmZone zone = UtmZone::from_epsg((north ? 32600 : 32700) + 1 + round % 60).value();
    const double meridian = 6.0 * zone.number() - 183.0;
    const LatLon corner{north ? lat : -lat - LocalProjection::kSideDeg,
                        meridian + between(random, -9.0, 9.0 - LocalProjection::kSideDeg)};
    const auto local = LocalProjection::over(zone, corner);
    if (!local) continue;  // UTM ends 500 km off the meridian
    ++tested;
    for (int i = 0; i < 20; ++i) {
      const LatLon point{corner.lat_deg + LocalProjection::kSideDeg * between(random, 0.0, 1.0),
                         corner.lon_deg + LocalProjection::kSideDeg * between(random, 0.0, 1.0)};
      const GridPoint exact = zone.project(point);
      const ProjectedPoint found = local->at(point);
      worst_m = std::max(worst_m, distance_m(found.point, exact));
      worst_rad = std::max(worst_rad, std::abs((found.convergence - zone.convergence(exact)).radians()));
    }
  }
  EXPECT_GT(tested, 100);
  EXPECT_LT(worst_m, LocalProjection::kMaxErrorM);
  EXPECT_LT(worst_rad, LocalProjection::kMaxTurn.radians());
}

TEST(PointProjector, GivesWhatTheZoneGivesForFewAndForManyPoints) {
  std::mt19937_64 random(2);
  const UtmZone zone = UtmZone::containing({-34.9, -56.2});
  PointProjector project(zone);
  for (int i = 0; i < 500; ++i) {
    // Over the corner of four boxes, and here and there far away.
    const LatLon point{i % 50 == 0 ? -60.0 : between(random, -34.8, -34.7), between(random, -56.3, -56.2)};
    const auto found = project(point);
    ASSERT_TRUE(found);
    EXPECT_LT(distance_m(found->point, zone.project(point)), LocalProjection::kMaxErrorM);
  }
}

TEST(PointProjector, KnowsWhereThereIsNoProjectionHoweverOftenItIsAsked) {
  PointProjector project(UtmZone::from_epsg(32634).value());
  for (int i = 0; i < 60; ++i) EXPECT_FALSE(project({40.0, -140.0}));
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(project({kNone, 20.0}), InvalidInput);
  EXPECT_THROW(project({40.0, kNone}), InvalidInput);
  EXPECT_THROW(project({91.0, 20.0}), InvalidInput);
  EXPECT_THROW(project({40.0, 1e9}), InvalidInput);
}

TEST(PointProjector, KnowsThatThereIsNoProjectionAtThePolesHoweverOftenItIsAsked) {
  PointProjector project(UtmZone::from_epsg(32634).value());
  for (int i = 0; i < 60; ++i) {
    EXPECT_FALSE(project({90.0, 21.0}));
    EXPECT_FALSE(project({-90.0, 21.0}));
  }
}

}  // namespace
}  // namespace roadfix
