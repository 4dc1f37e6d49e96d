#include "core/scan/fourier.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "core/scan/fourier_kernel.hpp"

namespace roadfix {

ComplexPlane::ComplexPlane(int side)
    : side_(side),
      stride_(side + kStripCols),
      re_(static_cast<std::size_t>(side * (stride_ / kStripCols))),
      im_(re_.size()) {
  assert(side % kStripCols == 0);
}

void ComplexPlane::clear(int rows) {
  for (float* plane : {re(), im()}) std::fill_n(plane, rows * stride_, 0.0F);
}

bool FourierTransform::is_side(int side) {
  const int twos = side % 3 == 0 ? side / 3 : side;
  return twos >= kMinSide && (twos & (twos - 1)) == 0;
}

FourierTransform::FourierTransform(int side) : side_(side) {
  assert(is_side(side));
  const auto add_twiddles = [this](int parts, int length) {
    for (int j = 0; j < length / parts; ++j) {
      for (int k = 1; k < parts; ++k) {
        const double angle = -2.0 * std::numbers::pi * j * k / length;
        twiddles_.push_back(static_cast<float>(std::cos(angle)));
        twiddles_.push_back(static_cast<float>(std::sin(angle)));
      }
    }
  };
  int length = side;
  if (side % 3 == 0) {
    add_twiddles(3, length);
    length /= 3;
  }
  for (; length >= 4; length /= 4) add_twiddles(4, length);
}

void FourierTransform::forward(const ComplexPlane& plane, Filled filled, ComplexPlane& scratch,
                               Spectrum& spectrum) const {
  assert(plane.side() == side_ && scratch.side() == side_ && spectrum.side() == side_);
  forward_transform(plane, filled, scratch, twiddles_.data(), spectrum);
}

void FourierTransform::backward_of_product(const Spectrum& a, const Spectrum& b, bool conjugate, IndexRange wanted,
                                           ComplexPlane& sums, ComplexPlane& scratch) const {
  assert(a.side() == side_ && b.side() == side_ && sums.side() == side_ && scratch.side() == side_);
  assert(wanted.first >= 0 && wanted.end <= side_);
  backward_transform_of_product(a, b, conjugate, twiddles_.data() + twiddles_.size(), wanted, sums, scratch);
}

}  // namespace roadfix
