// Sums over a patch at every place of a plane: the correlation of a large plane with many small patches, by transforms
// of tiles that fit the cache.
#pragma once

#include <cstddef>
#include <vector>

#include "core/match/fourier.hpp"

namespace roadfix {

/// Numbers in rows.
struct FloatPlane {
  int cols = 0;
  int rows = 0;
  std::vector<float> values;

  FloatPlane() = default;
  FloatPlane(int c, int r) : cols(c), rows(r), values(static_cast<std::size_t>(c) * static_cast<std::size_t>(r)) {}
  float* row(int r) { return values.data() + std::ptrdiff_t{r} * cols; }
  const float* row(int r) const { return values.data() + std::ptrdiff_t{r} * cols; }
  float& at(int col, int r) { return row(r)[col]; }
  float at(int col, int r) const { return row(r)[col]; }
};

/// Two planes of the same size are transformed at the cost of one.
struct FloatPlanes {
  FloatPlane first, second;
};

/// Thread-safe.
class Correlator {
 public:
  /// Sums begin so many cells before the plane and end as many after it.
  static constexpr int kLead = 2;

  /// One plane for pairs of patches, or a pair of planes (of the same size) for single patches; `second` is empty for
  /// one. Patches have at most patch x patch cells.
  Correlator(const FloatPlane& first, const FloatPlane& second, int patch);

  /// Of a patch, or of two where there is one plane; `second` is empty for one.
  ComplexPlane spectrum_of(const FloatPlane& first, const FloatPlane& second) const;

  /// Sum over each patch (or over the patch in each plane) at each place where it stays within the plane and its lead,
  /// else 0; the patch's first cell lies there, and place (0, 0) is (-kLead, -kLead). Turned by half a turn it is the
  /// patch's last cell, counted in the turned patch.
  FloatPlanes correlate(const ComplexPlane& patch_spectrum, bool half_turn) const;

  std::size_t bytes() const;

 private:
  struct Tile {
    int col = 0;  ///< of the plane, of its first cell
    int row = 0;
    ComplexPlane spectrum;
  };

  int cols_;
  int rows_;
  int patch_;
  bool pair_;
  FourierTransform fourier_;
  std::vector<Tile> tiles_;
};

}  // namespace roadfix
