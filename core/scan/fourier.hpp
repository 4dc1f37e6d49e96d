// Fourier transforms of square planes, for sums over a patch at every place of a plane.
#pragma once

#include <vector>

#include "core/scan/spectrum.hpp"
#include "core/units/index_range.hpp"

namespace roadfix {

/// The first columns and rows of a plane, the columns rounded up to kStripCols. What it holds beyond them counts as 0.
struct Filled {
  int cols = 0;
  int rows = 0;
};

/// Thread-safe.
class FourierTransform {
 public:
  static constexpr int kMinSide = 16;
  /// A power of two, or three times one that is no less than kMinSide.
  static bool is_side(int side);

  /// `side`: is_side().
  explicit FourierTransform(int side);
  int side() const { return side_; }

  /// Sum of x exp(-2 pi i (k . f) / side). The content of `scratch` is lost.
  void forward(const ComplexPlane& plane, Filled filled, ComplexPlane& scratch, Spectrum& spectrum) const;
  /// `sums` = side^2 times the plane that has the spectrum a * b or a * conj(b); outside of the wanted columns it holds
  /// anything. The content of `scratch` is lost.
  void backward_of_product(const Spectrum& a, const Spectrum& b, bool conjugate, IndexRange wanted, ComplexPlane& sums,
                           ComplexPlane& scratch) const;

 private:
  int side_;
  std::vector<float> twiddles_;  ///< of each butterfly of a stage, stage by stage: see fourier_kernel.hpp
};

}  // namespace roadfix
