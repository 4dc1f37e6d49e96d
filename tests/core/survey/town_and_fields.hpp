// A map of which a third tells places, a third does not, and a third is not known.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>

#include "core/grid/resample.hpp"
#include "core/survey/localizability.hpp"
#include "core/units/progress.hpp"
#include "tests/support/map_view.hpp"
#include "tests/support/street_map.hpp"

namespace roadfix::testing {

/// Winding streets, a third of fields, and a third that nobody has looked at; the thirds are 400 m wide, from west to
/// east, and 800 m high.
inline MapView town_fields_and_unknown_ground() {
  RoadGrid ground = street_map(22, {2.0, {300'000, -3'200'000}, 600, 400});
  paste(CellArray(200, 400, kNoRoad), ground.cells, 200, 0);
  paste(CellArray(200, 400), ground.cells, 400, 0);
  return view_of(ground);
}

/// Frames of which one fits into a third.
inline LocalizabilityQuery query_of_a_third() {
  LocalizabilityQuery query;
  query.footprint_m = 400.0;
  query.radius_m = 500.0;
  return query;
}

/// Expects to hear of each of `total` places in turn; `told` counts them.
inline OnProgress counted(std::int64_t& told, std::int64_t total) {
  return [&told, total](std::int64_t done, std::int64_t all) {
    EXPECT_EQ(done, ++told);
    EXPECT_EQ(all, total);
  };
}

}  // namespace roadfix::testing
