// What the tests of fixes share.
#pragma once

#include <gtest/gtest.h>

#include <random>

#include "core/locate/fix.hpp"
#include "tests/support/map_view.hpp"
#include "tests/support/street_map.hpp"

namespace roadfix::testing {

/// Some 100 km east of the central meridian of zone 34, at 57.7 north: convergence is more than a degree.
inline GridGeometry town(double width_m, double height_m) {
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

}  // namespace roadfix::testing
