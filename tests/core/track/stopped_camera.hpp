// What a camera or a link that has stopped goes on showing.
#pragma once

#include <cstdint>
#include <random>

#include "core/grid/feature_map.hpp"
#include "core/track/last_view.hpp"
#include "core/units/draws.hpp"
#include "tests/support/sketches.hpp"

namespace roadfix::testing {

/// The same cells, but so many of a hundred are road instead of none or none instead of road.
inline FeatureMap noisy(FeatureMap features, int percent, std::mt19937_64& random) {
  for (Cell& cell : features.cells.cells()) {
    if (uniform(random, 0.0, 100.0) < percent) cell = cell == kRoad ? kNoRoad : kRoad;
  }
  return features;
}

inline SentPicture of_bytes(std::uint64_t digest) { return {digest, {}}; }

/// Other bytes of a picture at each call, with some noise.
inline SentPicture encoded_anew(const PictureSketch& sketch) {
  static std::uint64_t digest = 1'000'000;
  return {++digest, with_parts_changed(sketch, 0.03)};
}

}  // namespace roadfix::testing
