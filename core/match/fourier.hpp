// Fourier transforms of square planes, for sums over a patch at every place of a plane. Spectra stay in the order in
// which they come (digits of the frequency reversed, axes swapped): products and the way back do not mind.
#pragma once

#include <cstddef>
#include <vector>

namespace roadfix {

/// Complex numbers in rows, real and imaginary parts apart.
class ComplexPlane {
 public:
  /// All zero. `side` is a multiple of 16.
  explicit ComplexPlane(int side);

  int side() const { return side_; }
  void clear();
  /// The same number everywhere.
  void fill(float real, float imaginary);
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

  std::size_t bytes() const { return (re_.size() + im_.size()) * sizeof(Block); }

 private:
  static constexpr int kAlignedFloats = 16;
  struct alignas(kAlignedFloats * sizeof(float)) Block {
    float values[kAlignedFloats] = {};
  };

  int side_;
  std::ptrdiff_t stride_;
  std::vector<Block> re_, im_;
};

/// Some columns of a plane: [first, last).
struct Columns {
  int first = 0;
  int last = 0;
};

/// Thread-safe.
class FourierTransform {
 public:
  static constexpr int kLeastSide = 16;

  /// `side`: a power of two, kLeastSide or more.
  explicit FourierTransform(int side);
  int side() const { return side_; }

  /// Sum of x exp(-2 pi i (k . f) / side), in place; `scratch` is of the same side, its content is lost.
  void forward(ComplexPlane& plane, ComplexPlane& scratch) const;
  /// From the order of forward(): side^2 times the plane that it came from.
  void backward(ComplexPlane& plane, ComplexPlane& scratch) const;
  /// `sums` = backward() of a * b or a * conj(b); outside of the wanted columns it holds anything.
  void backward_of_product(const ComplexPlane& a, const ComplexPlane& b, bool conjugate, Columns wanted,
                           ComplexPlane& sums, ComplexPlane& scratch) const;

 private:
  int side_;
  std::vector<float> turns_;  ///< six numbers for each butterfly of a stage, stage by stage
};

}  // namespace roadfix
