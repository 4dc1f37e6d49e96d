// Columns of complex numbers in vectors, and the butterflies of the Fourier transform. For fourier_kernel.cpp, which is
// compiled once per instruction set: instead of once for all, this is read once for each of them.
#if defined(ROADFIX_FOURIER_STRIP) == defined(HWY_TARGET_TOGGLE)
#ifdef ROADFIX_FOURIER_STRIP
#undef ROADFIX_FOURIER_STRIP
#else
#define ROADFIX_FOURIER_STRIP
#endif

#include <hwy/highway.h>

#include <cstddef>

#include "core/scan/spectrum.hpp"

HWY_BEFORE_NAMESPACE();
namespace roadfix {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::CappedTag<float, kStripCols> kFloats;
using Floats = hn::Vec<decltype(kFloats)>;

struct Complex {
  Floats re, im;
};

// No number is ever made empty: the constructor that g++ would write for it on Arm lacks the instruction set.
struct Complex3 {
  Complex a, b, c;
};
struct Complex4 {
  Complex a, b, c, d;
};

HWY_INLINE HWY_ATTR Complex operator+(Complex a, Complex b) { return {hn::Add(a.re, b.re), hn::Add(a.im, b.im)}; }
HWY_INLINE HWY_ATTR Complex operator-(Complex a, Complex b) { return {hn::Sub(a.re, b.re), hn::Sub(a.im, b.im)}; }
HWY_INLINE HWY_ATTR Complex times(Complex a, Complex b) {
  return {hn::NegMulAdd(a.im, b.im, hn::Mul(a.re, b.re)), hn::MulAdd(a.re, b.im, hn::Mul(a.im, b.re))};
}
HWY_INLINE HWY_ATTR Complex times_conjugate(Complex a, Complex b) {
  return {hn::MulAdd(a.im, b.im, hn::Mul(a.re, b.re)), hn::NegMulAdd(a.re, b.im, hn::Mul(a.im, b.re))};
}
HWY_INLINE HWY_ATTR Complex times_i(Complex a) { return {hn::Neg(a.im), a.re}; }
HWY_INLINE HWY_ATTR Complex twiddle_at(const float* twiddle) {
  return {hn::Set(kFloats, twiddle[0]), hn::Set(kFloats, twiddle[1])};
}
HWY_INLINE HWY_ATTR Complex load(const float* re, const float* im) {
  return {hn::Load(kFloats, re), hn::Load(kFloats, im)};
}

/// As many columns of a plane as a vector holds numbers.
struct Strip {
  float* re;
  float* im;
  std::ptrdiff_t stride;

  HWY_INLINE HWY_ATTR Complex at(int row) const { return load(re + row * stride, im + row * stride); }
  HWY_INLINE HWY_ATTR void put(int row, Complex value) const {
    hn::Store(value.re, kFloats, re + row * stride);
    hn::Store(value.im, kFloats, im + row * stride);
  }
  /// Every `step` rows from `row` on.
  HWY_INLINE HWY_ATTR void put(int row, int step, Complex3 values) const {
    put(row, values.a);
    put(row + step, values.b);
    put(row + 2 * step, values.c);
  }
  HWY_INLINE HWY_ATTR void put(int row, int step, Complex4 values) const {
    put(row, step, Complex3{values.a, values.b, values.c});
    put(row + 3 * step, values.d);
  }
};

/// The transform of three numbers (radix 3); backward it is the conjugate's.
HWY_INLINE HWY_ATTR Complex3 butterfly3(Complex a0, Complex a1, Complex a2, bool forward) {
  const Floats half = hn::Set(kFloats, 0.5F);
  const Floats height = hn::Set(kFloats, 0.8660254037844386F);  // sine of 60 degrees
  const Complex sum = a1 + a2;
  const Complex difference = forward ? a2 - a1 : a1 - a2;
  const Complex middle{hn::NegMulAdd(half, sum.re, a0.re), hn::NegMulAdd(half, sum.im, a0.im)};
  const Complex across = times_i({hn::Mul(height, difference.re), hn::Mul(height, difference.im)});
  return {a0 + sum, middle + across, middle - across};
}

/// The same of four (radix 4).
HWY_INLINE HWY_ATTR Complex4 butterfly4(Complex a0, Complex a1, Complex a2, Complex a3, bool forward) {
  const Complex even = a0 + a2;
  const Complex odd = a1 + a3;
  const Complex difference = a0 - a2;
  const Complex turned = times_i(forward ? a3 - a1 : a1 - a3);
  return {even + odd, difference + turned, even - odd, difference - turned};
}

}  // namespace HWY_NAMESPACE
}  // namespace roadfix
HWY_AFTER_NAMESPACE();

#endif
