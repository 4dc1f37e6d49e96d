// A plane of floats, row by row, for transforms and scans.
#pragma once

#include <cstddef>
#include <vector>

namespace roadfix {

struct FloatPlane {
  int cols = 0;
  int rows = 0;
  std::vector<float> values;

  FloatPlane() = default;
  FloatPlane(int c, int r) : cols(c), rows(r), values(static_cast<std::size_t>(c) * static_cast<std::size_t>(r)) {}
  /// Contents are undefined afterwards.
  void resize(int c, int r) {
    cols = c;
    rows = r;
    values.resize(static_cast<std::size_t>(c) * static_cast<std::size_t>(r));
  }
  float* row(int r) { return values.data() + std::ptrdiff_t{r} * cols; }
  const float* row(int r) const { return values.data() + std::ptrdiff_t{r} * cols; }
  float& at(int col, int r) { return row(r)[col]; }
  float at(int col, int r) const { return row(r)[col]; }
};

/// Two planes of the same size, which can be transformed at the cost of one.
struct FloatPlanes {
  FloatPlane first, second;
};

}  // namespace roadfix
