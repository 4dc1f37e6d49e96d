// Sketches of pictures that nobody took.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>

#include "core/grid/picture_sketch.hpp"

namespace roadfix::testing {

/// Every part lighter or darker than what lies around it.
inline PictureSketch random_sketch(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  PictureSketch sketch;
  for (std::int8_t& part : sketch.parts) part = (random() & 1U) != 0U ? 1 : -1;
  return sketch;
}

/// So many of its parts lighter instead of darker or darker instead of lighter, the first ones.
inline PictureSketch with_parts_changed(PictureSketch sketch, double share) {
  const double count = std::floor(share * static_cast<double>(sketch.parts.size()));
  std::for_each_n(sketch.parts.begin(), static_cast<std::size_t>(count),
                  [](std::int8_t& part) { part = static_cast<std::int8_t>(-part); });
  return sketch;
}

}  // namespace roadfix::testing
