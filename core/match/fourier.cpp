#include "core/match/fourier.hpp"

// clang-format off: foreach_target compiles this file once per instruction set, and must come before highway.h
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/match/fourier.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace roadfix {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::CappedTag<float, 16> kFloats;
using Floats = hn::Vec<decltype(kFloats)>;

struct Complex {
  Floats re, im;
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
HWY_INLINE HWY_ATTR Complex turn_at(const float* turn) {
  return {hn::Set(kFloats, turn[0]), hn::Set(kFloats, turn[1])};
}

/// Some columns of a plane.
struct Strip {
  float* re;
  float* im;
  std::ptrdiff_t stride;

  HWY_INLINE HWY_ATTR Complex at(int row) const {
    return {hn::Load(kFloats, re + row * stride), hn::Load(kFloats, im + row * stride)};
  }
  HWY_INLINE HWY_ATTR void put(int row, Complex value) const {
    hn::Store(value.re, kFloats, re + row * stride);
    hn::Store(value.im, kFloats, im + row * stride);
  }
};

/// Decimation in frequency: each stage turns a transform into four of a quarter of its length.
HWY_ATTR void forward_strip(const Strip& strip, int side, const float* turns) {
  int length = side;
  for (; length >= 4; length /= 4) {
    const int quarter = length / 4;
    for (int j = 0; j < quarter; ++j, turns += 6) {
      const Complex turn1 = turn_at(turns);
      const Complex turn2 = turn_at(turns + 2);
      const Complex turn3 = turn_at(turns + 4);
      for (int row = j; row < side; row += length) {
        const Complex a0 = strip.at(row);
        const Complex a1 = strip.at(row + quarter);
        const Complex a2 = strip.at(row + 2 * quarter);
        const Complex a3 = strip.at(row + 3 * quarter);
        const Complex even = a0 + a2;
        const Complex odd = a1 + a3;
        const Complex difference = a0 - a2;
        const Complex turned = times_i(a1 - a3);
        strip.put(row, even + odd);
        strip.put(row + quarter, times(difference - turned, turn1));
        strip.put(row + 2 * quarter, times(even - odd, turn2));
        strip.put(row + 3 * quarter, times(difference + turned, turn3));
      }
    }
  }
  for (int row = 0; length == 2 && row < side; row += 2) {
    const Complex a0 = strip.at(row);
    const Complex a1 = strip.at(row + 1);
    strip.put(row, a0 + a1);
    strip.put(row + 1, a0 - a1);
  }
}

/// The stages of forward_strip() undone, last one first; `turns` points behind the last.
HWY_ATTR void backward_strip(const Strip& strip, int side, const float* turns) {
  int length = side;
  while (length > 4) length /= 4;
  if (length == 2) {
    for (int row = 0; row < side; row += 2) {
      const Complex a0 = strip.at(row);
      const Complex a1 = strip.at(row + 1);
      strip.put(row, a0 + a1);
      strip.put(row + 1, a0 - a1);
    }
    length = 8;
  }
  for (; length <= side; length *= 4) {
    const int quarter = length / 4;
    turns -= std::ptrdiff_t{6} * quarter;
    const float* turn = turns;
    for (int j = 0; j < quarter; ++j, turn += 6) {
      const Complex turn1 = turn_at(turn);
      const Complex turn2 = turn_at(turn + 2);
      const Complex turn3 = turn_at(turn + 4);
      for (int row = j; row < side; row += length) {
        const Complex a0 = strip.at(row);
        const Complex a1 = times_conjugate(strip.at(row + quarter), turn1);
        const Complex a2 = times_conjugate(strip.at(row + 2 * quarter), turn2);
        const Complex a3 = times_conjugate(strip.at(row + 3 * quarter), turn3);
        const Complex even = a0 + a2;
        const Complex odd = a1 + a3;
        const Complex difference = a0 - a2;
        const Complex turned = times_i(a1 - a3);
        strip.put(row, even + odd);
        strip.put(row + quarter, difference + turned);
        strip.put(row + 2 * quarter, even - odd);
        strip.put(row + 3 * quarter, difference - turned);
      }
    }
  }
}

HWY_ATTR void transform_strip(ComplexPlane& plane, int col, const float* turns, bool forward) {
  const Strip strip{plane.re() + col, plane.im() + col, plane.stride()};
  if (forward) {
    forward_strip(strip, plane.side(), turns);
  } else {
    backward_strip(strip, plane.side(), turns);
  }
}

/// Some columns become rows; a multiple of four.
HWY_ATTR void transpose(const float* in, float* out, int side, std::ptrdiff_t stride, int first_col, int last_col) {
#if HWY_TARGET == HWY_SCALAR
  for (int row = 0; row < side; ++row) {
    for (int col = first_col; col < last_col; ++col) out[col * stride + row] = in[row * stride + col];
  }
#else
  constexpr hn::FixedTag<float, 4> kFour;
  constexpr hn::FixedTag<double, 2> kPairs;
  for (int col = first_col; col < last_col; col += 4) {
    for (int row = 0; row < side; row += 4) {
      const float* from = in + row * stride + col;
      const auto r0 = hn::Load(kFour, from);
      const auto r1 = hn::Load(kFour, from + stride);
      const auto r2 = hn::Load(kFour, from + 2 * stride);
      const auto r3 = hn::Load(kFour, from + 3 * stride);
      const auto low01 = hn::BitCast(kPairs, hn::InterleaveLower(kFour, r0, r1));
      const auto low23 = hn::BitCast(kPairs, hn::InterleaveLower(kFour, r2, r3));
      const auto high01 = hn::BitCast(kPairs, hn::InterleaveUpper(kFour, r0, r1));
      const auto high23 = hn::BitCast(kPairs, hn::InterleaveUpper(kFour, r2, r3));
      float* to = out + col * stride + row;
      hn::Store(hn::BitCast(kFour, hn::InterleaveLower(kPairs, low01, low23)), kFour, to);
      hn::Store(hn::BitCast(kFour, hn::InterleaveUpper(kPairs, low01, low23)), kFour, to + stride);
      hn::Store(hn::BitCast(kFour, hn::InterleaveLower(kPairs, high01, high23)), kFour, to + 2 * stride);
      hn::Store(hn::BitCast(kFour, hn::InterleaveUpper(kPairs, high01, high23)), kFour, to + 3 * stride);
    }
  }
#endif
}

/// Transforms a strip of columns, and turns it into rows while the cache holds it.
HWY_ATTR void strip_to_rows(ComplexPlane& plane, ComplexPlane& rows, int col, const float* turns, bool forward) {
  const int last = col + static_cast<int>(hn::Lanes(kFloats));
  transform_strip(plane, col, turns, forward);
  transpose(plane.re(), rows.re(), plane.side(), plane.stride(), col, last);
  transpose(plane.im(), rows.im(), plane.side(), plane.stride(), col, last);
}

HWY_ATTR void transform_columns(ComplexPlane& plane, const float* turns, bool forward, Columns wanted) {
  const int lanes = static_cast<int>(hn::Lanes(kFloats));
  for (int col = wanted.first / lanes * lanes; col < wanted.last; col += lanes) {
    transform_strip(plane, col, turns, forward);
  }
}

HWY_ATTR void transform(ComplexPlane& plane, ComplexPlane& scratch, const float* turns, bool forward) {
  const int lanes = static_cast<int>(hn::Lanes(kFloats));
  for (int col = 0; col < plane.side(); col += lanes) strip_to_rows(plane, scratch, col, turns, forward);
  transform_columns(scratch, turns, forward, {0, plane.side()});
}

HWY_ATTR void product_strip(const ComplexPlane& a, const ComplexPlane& b, bool conjugate, int col, ComplexPlane& out) {
  for (int row = 0; row < a.side(); ++row) {
    const Complex x{hn::Load(kFloats, a.re(row) + col), hn::Load(kFloats, a.im(row) + col)};
    const Complex y{hn::Load(kFloats, b.re(row) + col), hn::Load(kFloats, b.im(row) + col)};
    const Complex z = conjugate ? times_conjugate(x, y) : times(x, y);
    hn::Store(z.re, kFloats, out.re(row) + col);
    hn::Store(z.im, kFloats, out.im(row) + col);
  }
}

HWY_ATTR void backward_of_product(const ComplexPlane& a, const ComplexPlane& b, bool conjugate, const float* turns,
                                  Columns wanted, ComplexPlane& sums, ComplexPlane& scratch) {
  const int lanes = static_cast<int>(hn::Lanes(kFloats));
  for (int col = 0; col < a.side(); col += lanes) {
    product_strip(a, b, conjugate, col, sums);
    strip_to_rows(sums, scratch, col, turns, false);
  }
  transform_columns(scratch, turns, false, wanted);
}

}  // namespace HWY_NAMESPACE
}  // namespace roadfix
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <utility>

namespace roadfix {

HWY_EXPORT(transform);
HWY_EXPORT(backward_of_product);

ComplexPlane::ComplexPlane(int side)
    : side_(side),
      stride_(side + kAlignedFloats),
      re_(static_cast<std::size_t>(side * (stride_ / kAlignedFloats))),
      im_(re_.size()) {
  assert(side % kAlignedFloats == 0);
}

void ComplexPlane::clear() { fill(0.0F, 0.0F); }

void ComplexPlane::fill(float real, float imaginary) {
  std::fill_n(re(), re_.size() * kAlignedFloats, real);
  std::fill_n(im(), im_.size() * kAlignedFloats, imaginary);
}

FourierTransform::FourierTransform(int side) : side_(side) {
  assert(side >= kLeastSide && (side & (side - 1)) == 0);
  for (int length = side; length >= 4; length /= 4) {
    for (int j = 0; j < length / 4; ++j) {
      for (int k = 1; k <= 3; ++k) {
        const double angle = -2.0 * std::numbers::pi * j * k / length;
        turns_.push_back(static_cast<float>(std::cos(angle)));
        turns_.push_back(static_cast<float>(std::sin(angle)));
      }
    }
  }
}

void FourierTransform::forward(ComplexPlane& plane, ComplexPlane& scratch) const {
  assert(plane.side() == side_ && scratch.side() == side_);
  HWY_DYNAMIC_DISPATCH(transform)(plane, scratch, turns_.data(), true);
  std::swap(plane, scratch);
}

void FourierTransform::backward(ComplexPlane& plane, ComplexPlane& scratch) const {
  assert(plane.side() == side_ && scratch.side() == side_);
  HWY_DYNAMIC_DISPATCH(transform)(plane, scratch, turns_.data() + turns_.size(), false);
  std::swap(plane, scratch);
}

void FourierTransform::backward_of_product(const ComplexPlane& a, const ComplexPlane& b, bool conjugate, Columns wanted,
                                           ComplexPlane& sums, ComplexPlane& scratch) const {
  assert(a.side() == side_ && b.side() == side_ && sums.side() == side_ && scratch.side() == side_);
  assert(wanted.first >= 0 && wanted.last <= side_);
  HWY_DYNAMIC_DISPATCH(backward_of_product)
  (a, b, conjugate, turns_.data() + turns_.size(), wanted, sums, scratch);
  std::swap(sums, scratch);
}

}  // namespace roadfix

#endif  // HWY_ONCE
