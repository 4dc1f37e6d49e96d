#include "core/scan/fourier_kernel.hpp"

#include <algorithm>

// clang-format off: foreach_target compiles this file once per instruction set, and must come before highway.h
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/scan/fourier_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

#include "core/scan/fourier_strip.hpp"

HWY_BEFORE_NAMESPACE();
namespace roadfix {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr int kCachedRows = 128;  // of a strip, beside what it is read from

HWY_ATTR void forward_strip(const Strip& strip, int side, const float* twiddles) {
  int length = side;
  if (side % 3 == 0) {
    length /= 3;
    for (int j = 0; j < length; ++j, twiddles += 4) {
      const Complex3 x = butterfly3(strip.at(j), strip.at(j + length), strip.at(j + 2 * length), true);
      strip.put(j, length, Complex3{x.a, times(x.b, twiddle_at(twiddles)), times(x.c, twiddle_at(twiddles + 2))});
    }
  }
  for (; length >= 4; length /= 4) {
    const int quarter = length / 4;
    for (int j = 0; j < quarter; ++j, twiddles += 6) {
      for (int row = j; row < side; row += length) {
        const Complex4 x = butterfly4(strip.at(row), strip.at(row + quarter), strip.at(row + 2 * quarter),
                                      strip.at(row + 3 * quarter), true);
        strip.put(row, quarter,
                  Complex4{x.a, times(x.b, twiddle_at(twiddles)), times(x.c, twiddle_at(twiddles + 2)),
                           times(x.d, twiddle_at(twiddles + 4))});
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

/// Undoes the last stage of radix 4, all twiddles of which are 1, or that of radix 2 and the one before it
/// (`with_radix2`): in one go, from wherever `at(row)` takes the numbers. `twiddles` points behind those of the stages
/// undone.
template <typename At>
HWY_INLINE HWY_ATTR void first_backward(const At& at, bool with_radix2, const Strip& strip, int first, int last,
                                        const float* twiddles) {
  if (!with_radix2) {
    for (int row = first; row < last; row += 4) {
      strip.put(row, 1, butterfly4(at(row), at(row + 1), at(row + 2), at(row + 3), false));
    }
    return;
  }
  const Complex twiddle1 = twiddle_at(twiddles - 6);
  const Complex twiddle2 = twiddle_at(twiddles - 4);
  const Complex twiddle3 = twiddle_at(twiddles - 2);
  for (int row = first; row < last; row += 8) {
    const Complex a0 = at(row), a1 = at(row + 1), a2 = at(row + 2), a3 = at(row + 3);
    const Complex a4 = at(row + 4), a5 = at(row + 5), a6 = at(row + 6), a7 = at(row + 7);
    strip.put(row, 2, butterfly4(a0 + a1, a2 + a3, a4 + a5, a6 + a7, false));
    strip.put(row + 1, 2,
              butterfly4(a0 - a1, times_conjugate(a2 - a3, twiddle1), times_conjugate(a4 - a5, twiddle2),
                         times_conjugate(a6 - a7, twiddle3), false));
  }
}

/// Undoes a stage of radix 4 for the rows [first, last).
HWY_INLINE HWY_ATTR void radix4_backward(const Strip& strip, int length, int first, int last, const float* twiddle) {
  const int quarter = length / 4;
  for (int j = first; j < first + quarter; ++j, twiddle += 6) {
    const Complex twiddle1 = twiddle_at(twiddle);
    const Complex twiddle2 = twiddle_at(twiddle + 2);
    const Complex twiddle3 = twiddle_at(twiddle + 4);
    for (int row = j; row < last; row += length) {
      strip.put(row, quarter,
                butterfly4(strip.at(row), times_conjugate(strip.at(row + quarter), twiddle1),
                           times_conjugate(strip.at(row + 2 * quarter), twiddle2),
                           times_conjugate(strip.at(row + 3 * quarter), twiddle3), false));
    }
  }
}

/// The stages of forward_strip() undone, last one first; `twiddles` points behind the last ones.
template <typename At>
HWY_INLINE HWY_ATTR void backward_strip(const At& at, const Strip& strip, int side, const float* twiddles) {
  const int whole = side % 3 == 0 ? side / 3 : side;
  int twos = whole;
  while (twos > 2) twos /= 4;
  const int shortest = twos == 2 ? 8 : 4;
  // What the first cache holds goes through all stages that it can.
  int block = shortest;
  while (block * 4 <= std::min(kCachedRows, whole)) block *= 4;
  const float* twiddle = twiddles;
  for (int first = 0; first < side; first += block) {
    twiddle = twiddles;
    first_backward(at, twos == 2, strip, first, first + block, twiddle);
    twiddle -= twos == 2 ? 12 : 6;
    for (int length = 4 * shortest; length <= block; length *= 4) {
      twiddle -= std::ptrdiff_t{6} * (length / 4);
      radix4_backward(strip, length, first, first + block, twiddle);
    }
  }
  for (int length = 4 * block; length <= whole; length *= 4) {
    twiddle -= std::ptrdiff_t{6} * (length / 4);
    radix4_backward(strip, length, 0, side, twiddle);
  }
  if (whole == side) return;
  twiddle -= std::ptrdiff_t{4} * whole;
  for (int j = 0; j < whole; ++j, twiddle += 4) {
    strip.put(j, whole,
              butterfly3(strip.at(j), times_conjugate(strip.at(j + whole), twiddle_at(twiddle)),
                         times_conjugate(strip.at(j + 2 * whole), twiddle_at(twiddle + 2)), false));
  }
}

/// Rows [first, last) of some columns, each kept in_stride after the one before, become columns; all multiples of four.
HWY_ATTR void transpose(const float* in, std::ptrdiff_t in_stride, int first, int last, int cols, float* out,
                        std::ptrdiff_t out_stride) {
#if HWY_TARGET == HWY_SCALAR
  for (int row = first; row < last; ++row) {
    for (int col = 0; col < cols; ++col) out[col * out_stride + row] = in[row * in_stride + col];
  }
#else
  constexpr hn::FixedTag<float, 4> kFour;
  constexpr hn::FixedTag<double, 2> kPairs;
  for (int col = 0; col < cols; col += 4) {
    for (int row = first; row < last; row += 4) {
      const float* from = in + row * in_stride + col;
      const auto r0 = hn::Load(kFour, from);
      const auto r1 = hn::Load(kFour, from + in_stride);
      const auto r2 = hn::Load(kFour, from + 2 * in_stride);
      const auto r3 = hn::Load(kFour, from + 3 * in_stride);
      const auto low01 = hn::BitCast(kPairs, hn::InterleaveLower(kFour, r0, r1));
      const auto low23 = hn::BitCast(kPairs, hn::InterleaveLower(kFour, r2, r3));
      const auto high01 = hn::BitCast(kPairs, hn::InterleaveUpper(kFour, r0, r1));
      const auto high23 = hn::BitCast(kPairs, hn::InterleaveUpper(kFour, r2, r3));
      float* to = out + col * out_stride + row;
      hn::Store(hn::BitCast(kFour, hn::InterleaveLower(kPairs, low01, low23)), kFour, to);
      hn::Store(hn::BitCast(kFour, hn::InterleaveUpper(kPairs, low01, low23)), kFour, to + out_stride);
      hn::Store(hn::BitCast(kFour, hn::InterleaveLower(kPairs, high01, high23)), kFour, to + 2 * out_stride);
      hn::Store(hn::BitCast(kFour, hn::InterleaveUpper(kPairs, high01, high23)), kFour, to + 3 * out_stride);
    }
  }
#endif
}

/// The first rows of some columns of a plane; the others are 0.
HWY_INLINE HWY_ATTR void copy_rows(const ComplexPlane& from, int col, int filled_rows, const Strip& to) {
  const int side = from.side();
  for (int row = 0; row < filled_rows; ++row) to.put(row, load(from.re(row) + col, from.im(row) + col));
  for (int row = filled_rows; row < side; ++row) to.put(row, {hn::Zero(kFloats), hn::Zero(kFloats)});
}

HWY_ATTR void forward(const ComplexPlane& plane, Filled filled, ComplexPlane& scratch, const float* twiddles,
                      Spectrum& spectrum) {
  const int lanes = static_cast<int>(hn::Lanes(kFloats));
  const int side = plane.side();
  const std::ptrdiff_t stride = plane.stride();
  const auto strip_at = [&](int col) HWY_ATTR {
    float* strip = spectrum.strip(col / kStripCols) + col % kStripCols;
    return Strip{strip, strip + kStripCols, std::ptrdiff_t{2} * kStripCols};
  };
  int filled_cols = 0;
  for (; filled_cols < filled.cols; filled_cols += lanes) {
    const Strip strip = strip_at(0);
    copy_rows(plane, filled_cols, filled.rows, strip);
    forward_strip(strip, side, twiddles);
    transpose(strip.re, strip.stride, 0, side, lanes, scratch.re(filled_cols), stride);
    transpose(strip.im, strip.stride, 0, side, lanes, scratch.im(filled_cols), stride);
  }
  for (int col = 0; col < side; col += lanes) {
    const Strip strip = strip_at(col);
    copy_rows(scratch, col, filled_cols, strip);
    forward_strip(strip, side, twiddles);
  }
}

/// Some columns of the product of two spectra.
template <bool kConjugate>
struct ProductStrip {
  const float* a;
  const float* b;

  HWY_INLINE HWY_ATTR Complex operator()(int row) const {
    const std::ptrdiff_t at = std::ptrdiff_t{2} * kStripCols * row;
    const Complex x = load(a + at, a + at + kStripCols);
    const Complex y = load(b + at, b + at + kStripCols);
    return kConjugate ? times_conjugate(x, y) : times(x, y);
  }
};

template <bool kConjugate>
HWY_ATTR void backward(const Spectrum& a, const Spectrum& b, const float* twiddles, IndexRange wanted,
                       ComplexPlane& sums, ComplexPlane& scratch) {
  const int lanes = static_cast<int>(hn::Lanes(kFloats));
  const int side = a.side();
  const int first = wanted.first / kStripCols * kStripCols;
  const int last = (wanted.end + kStripCols - 1) / kStripCols * kStripCols;
  // Half of the transform in a strip that the first cache holds; then its wanted rows become columns.
  const Strip strip{scratch.re(), scratch.im(), lanes};
  for (int col = 0; col < side; col += lanes) {
    const ProductStrip<kConjugate> product{a.strip(col / kStripCols) + col % kStripCols,
                                           b.strip(col / kStripCols) + col % kStripCols};
    backward_strip(product, strip, side, twiddles);
    transpose(strip.re, lanes, first, last, lanes, sums.re(col), sums.stride());
    transpose(strip.im, lanes, first, last, lanes, sums.im(col), sums.stride());
  }
  for (int col = first; col < last; col += lanes) {
    const Strip rows{sums.re() + col, sums.im() + col, sums.stride()};
    backward_strip([&](int row) HWY_ATTR { return rows.at(row); }, rows, side, twiddles);
  }
}

HWY_ATTR void backward_of_product(const Spectrum& a, const Spectrum& b, bool conjugate, const float* twiddles,
                                  IndexRange wanted, ComplexPlane& sums, ComplexPlane& scratch) {
  if (conjugate) {
    backward<true>(a, b, twiddles, wanted, sums, scratch);
  } else {
    backward<false>(a, b, twiddles, wanted, sums, scratch);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace roadfix
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace roadfix {

HWY_EXPORT(forward);
HWY_EXPORT(backward_of_product);

void forward_transform(const ComplexPlane& plane, Filled filled, ComplexPlane& scratch, const float* twiddles,
                       Spectrum& spectrum) {
  HWY_DYNAMIC_DISPATCH(forward)(plane, filled, scratch, twiddles, spectrum);
}

void backward_transform_of_product(const Spectrum& a, const Spectrum& b, bool conjugate, const float* twiddles,
                                   IndexRange wanted, ComplexPlane& sums, ComplexPlane& scratch) {
  HWY_DYNAMIC_DISPATCH(backward_of_product)(a, b, conjugate, twiddles, wanted, sums, scratch);
}

}  // namespace roadfix

#endif  // HWY_ONCE
