// Complex numbers on squares: planes in rows, and their spectra in an order of the transform's own.
#pragma once

#include <cstddef>
#include <vector>

namespace roadfix {

/// So many columns are transformed side by side.
inline constexpr int kStripCols = 16;

/// Room for floats that vectors may be loaded from.
struct alignas(kStripCols * sizeof(float)) FloatBlock {
  float values[kStripCols] = {};
};

/// Complex numbers in rows, real and imaginary parts apart.
class ComplexPlane {
 public:
  /// All zero. `side` is a multiple of kStripCols.
  explicit ComplexPlane(int side);

  int side() const { return side_; }
  /// The first rows.
  void clear(int rows);
  /// Floats from one row to the next: not a power of two, which would crowd the cache.
  std::ptrdiff_t stride() const { return stride_; }
  float* re() { return re_.data()->values; }
  float* im() { return im_.data()->values; }
  const float* re() const { return re_.data()->values; }
  const float* im() const { return im_.data()->values; }
  float* re(int row) { return re() + row * stride_; }
  float* im(int row) { return im() + row * stride_; }
  const float* re(int row) const { return re() + row * stride_; }
  const float* im(int row) const { return im() + row * stride_; }

 private:
  int side_;
  std::ptrdiff_t stride_;
  std::vector<FloatBlock> re_, im_;
};

/// The frequencies of a plane, strip after strip in the order in which a product reads them: digits of the frequencies
/// are reversed, axes swapped.
class Spectrum {
 public:
  explicit Spectrum(int side)
      : side_(side), blocks_(static_cast<std::size_t>(side) * static_cast<std::size_t>(side / kStripCols) * 2) {}

  int side() const { return side_; }
  /// The strip's real parts of the first row; its imaginary parts, and then the next row, follow.
  float* strip(int index) { return blocks_[first_block(index)].values; }
  const float* strip(int index) const { return blocks_[first_block(index)].values; }
  /// The plane's sums, which stand at frequency 0.
  float sum_re() const { return blocks_[0].values[0]; }
  float sum_im() const { return blocks_[1].values[0]; }
  std::size_t bytes() const { return blocks_.size() * sizeof(FloatBlock); }

 private:
  std::size_t first_block(int strip) const {
    return static_cast<std::size_t>(strip) * static_cast<std::size_t>(side_) * 2;
  }

  int side_;
  std::vector<FloatBlock> blocks_;
};

}  // namespace roadfix
