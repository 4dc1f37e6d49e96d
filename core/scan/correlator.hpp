// The correlation of a large plane with many small patches, at every place, by transforms of tiles that fit the cache.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/scan/float_plane.hpp"
#include "core/scan/fourier.hpp"

namespace roadfix {

/// Thread-safe.
class Correlator {
 public:
  /// Places begin so many cells before the plane and end as many after it.
  static constexpr int kLead = 2;

  /// Either one plane (`second` is empty), to be correlated with a pair of patches at a time, or two planes of the same
  /// size, with one patch at a time. Patches have at most patch x patch cells. The sums of neighbouring tiles share
  /// `overlap` rows or columns.
  Correlator(const FloatPlane& first, const FloatPlane& second, int patch, int overlap = 0);

  /// Working memory of side(), overwritten by each call.
  struct Workspace {
    ComplexPlane sums, scratch;
    explicit Workspace(int side) : sums(side), scratch(side) {}
  };

  /// The spectrum of a patch (`second` is empty) or, if there is one plane, of two.
  void spectrum_of(const FloatPlane& first, const FloatPlane& second, Workspace& workspace, Spectrum& spectrum) const;

  /// Size of the planes that correlate() gives.
  int sum_cols() const { return cols_ + 2 * kLead; }
  int sum_rows() const { return rows_ + 2 * kLead; }
  /// The sums of products for each patch (or each plane) with the patch's first cell at each place, 0 where it does not
  /// stay within the plane and its lead. Element (0, 0) is the place (-kLead, -kLead). With `half_turn` the patch is
  /// turned by half a turn about its first cell.
  void correlate(const Spectrum& patch_spectrum, bool half_turn, Workspace& workspace, FloatPlanes& result) const;

  /// The places of one tile, and its sums there: scale * first[r * stride + c], likewise the second.
  struct TileSums {
    int col = 0;
    int row = 0;
    int cols = 0;
    int rows = 0;
    const float* first = nullptr;
    const float* second = nullptr;
    std::ptrdiff_t stride = 0;
    float first_scale = 1.0F;
    float second_scale = 1.0F;
  };
  int side() const { return fourier_.side(); }
  std::size_t tiles() const { return tiles_.size(); }
  /// The result points into the workspace, which is of side(). Without places where the tile has none.
  TileSums correlate_tile(std::size_t tile, const Spectrum& patch_spectrum, bool half_turn, Workspace& workspace) const;

  std::size_t bytes() const;

 private:
  struct Tile {
    int col = 0;  ///< of the plane, of its first cell
    int row = 0;
    std::optional<Spectrum> spectrum;  ///< none where all its cells are alike: their sums are known without
    float first = 0.0F;                ///< what they are then
    float second = 0.0F;
  };

  Tile tile_at(const FloatPlane& first, const FloatPlane& second, int col, int row, Workspace& workspace) const;

  int cols_;
  int rows_;
  int patch_;
  bool pair_;
  FourierTransform fourier_;
  std::vector<Tile> tiles_;
};

}  // namespace roadfix
