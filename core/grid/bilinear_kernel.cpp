#include "core/grid/bilinear_kernel.hpp"

// clang-format off: foreach_target compiles this file once per instruction set, and must come before highway.h
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/grid/bilinear_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

#ifndef ROADFIX_QUAD_PLANE
#define ROADFIX_QUAD_PLANE
namespace roadfix {

struct QuadPlane {
  const std::int32_t* quads;
  int cols;  ///< of the source: a row of quads is one longer
  int rows;
};

}  // namespace roadfix
#endif

HWY_BEFORE_NAMESPACE();
namespace roadfix {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::CappedTag<double, 8> kDoubles;
constexpr hn::Rebind<std::int32_t, decltype(kDoubles)> kInts;
constexpr hn::Rebind<std::uint8_t, decltype(kDoubles)> kBytes;
using Doubles = hn::Vec<decltype(kDoubles)>;
using Ints = hn::Vec<decltype(kInts)>;

struct Quads {
  Doubles above_left, above_right, below_left, below_right;
};

HWY_INLINE HWY_ATTR Quads parted(Ints quads) {
  const Ints byte = hn::Set(kInts, 255);
  const auto cell = [&](Ints bits) HWY_ATTR { return hn::PromoteTo(kDoubles, hn::And(bits, byte)); };
  return {cell(quads), cell(hn::ShiftRight<8>(quads)), cell(hn::ShiftRight<16>(quads)),
          cell(hn::ShiftRight<24>(quads))};
}

/// Of which quads a byte is 255: of the others none borrows when 1 is taken from each byte's complement.
HWY_INLINE HWY_ATTR auto any_unobserved(Ints quads) {
  const Ints borrowed = hn::Sub(hn::Not(quads), hn::Set(kInts, 0x01010101));
  const Ints high_bits = hn::Set(kInts, static_cast<std::int32_t>(0x80808080U));
  return hn::Ne(hn::And(hn::And(borrowed, quads), high_bits), hn::Zero(kInts));
}
static_assert(kUnobserved == 255);

/// bilinear() where all four cells were observed.
HWY_INLINE HWY_ATTR Doubles observed_mean(const Quads& q, Doubles fx, Doubles fy) {
  const Doubles upper = hn::Add(q.above_left, hn::Mul(fx, hn::Sub(q.above_right, q.above_left)));
  const Doubles lower = hn::Add(q.below_left, hn::Mul(fx, hn::Sub(q.below_right, q.below_left)));
  return hn::Add(hn::Add(upper, hn::Mul(fy, hn::Sub(lower, upper))), hn::Set(kDoubles, 0.5));
}

/// WeightedMean of the cells that were observed; `mean` where all were.
HWY_INLINE HWY_ATTR Doubles partial_mean(const Quads& q, Doubles fx, Doubles fy, Doubles mean) {
  const Doubles one = hn::Set(kDoubles, 1.0);
  const Doubles unobserved = hn::Set(kDoubles, double{kUnobserved});
  Doubles total = hn::Zero(kDoubles);
  Doubles observed = total;
  Doubles sum = total;
  const auto add = [&](Doubles cell, Doubles weight) HWY_ATTR {
    const auto seen = hn::Ne(cell, unobserved);
    total = hn::Add(total, weight);
    observed = hn::Add(observed, hn::IfThenElseZero(seen, weight));
    sum = hn::Add(sum, hn::IfThenElseZero(seen, hn::Mul(weight, cell)));
    return seen;
  };
  const Doubles left = hn::Sub(one, fx);
  const Doubles above = hn::Sub(one, fy);
  const auto seen0 = add(q.above_left, hn::Mul(left, above));
  const auto seen1 = add(q.above_right, hn::Mul(fx, above));
  const auto seen2 = add(q.below_left, hn::Mul(left, fy));
  const auto seen3 = add(q.below_right, hn::Mul(fx, fy));
  const auto whole = hn::And(hn::And(seen0, seen1), hn::And(seen2, seen3));
  const auto enough =
      hn::And(hn::Gt(observed, hn::Zero(kDoubles)), hn::Ge(observed, hn::Mul(hn::Set(kDoubles, 0.5), total)));
  const Doubles part = hn::Add(hn::Div(sum, hn::IfThenElse(enough, observed, one)), hn::Set(kDoubles, 0.5));
  return hn::IfThenElse(whole, mean, hn::IfThenElse(enough, part, unobserved));
}

void sample_row(const QuadPlane& source, const Placement& placement, int row, int first, int last, Cell* out) {
  const int step = static_cast<int>(hn::Lanes(kDoubles));
  const Doubles half = hn::Set(kDoubles, 0.5);
  const Doubles one = hn::Set(kDoubles, 1.0);
  const Doubles none = hn::Set(kDoubles, -1.0);
  const Doubles cols = hn::Set(kDoubles, source.cols);
  const Doubles rows = hn::Set(kDoubles, source.rows);
  const Doubles right_col = hn::Set(kDoubles, placement.right.col);
  const Doubles right_row = hn::Set(kDoubles, placement.right.row);
  const Doubles origin_col = hn::Set(kDoubles, placement.origin.col);
  const Doubles origin_row = hn::Set(kDoubles, placement.origin.row);
  const Doubles down_col = hn::Set(kDoubles, (row + 0.5) * placement.down.col);
  const Doubles down_row = hn::Set(kDoubles, (row + 0.5) * placement.down.row);
  const Ints stride = hn::Set(kInts, source.cols + 1);
  for (int col = first; col < last; col += step) {
    const Doubles middle = hn::Add(hn::Iota(kDoubles, col), half);
    const Doubles x = hn::Sub(hn::Add(hn::Add(origin_col, hn::Mul(middle, right_col)), down_col), half);
    const Doubles y = hn::Sub(hn::Add(hn::Add(origin_row, hn::Mul(middle, right_row)), down_row), half);
    const auto within = hn::And(hn::And(hn::Gt(x, none), hn::Gt(y, none)), hn::And(hn::Lt(x, cols), hn::Lt(y, rows)));
    const Ints quad_col = hn::DemoteTo(kInts, hn::IfThenElseZero(within, hn::Add(x, one)));
    const Ints quad_row = hn::DemoteTo(kInts, hn::IfThenElseZero(within, hn::Add(y, one)));
    const Doubles fx = hn::Sub(x, hn::Sub(hn::PromoteTo(kDoubles, quad_col), one));
    const Doubles fy = hn::Sub(y, hn::Sub(hn::PromoteTo(kDoubles, quad_row), one));
    const Ints quads = hn::GatherIndex(kInts, source.quads, hn::Add(hn::Mul(quad_row, stride), quad_col));
    const Quads q = parted(quads);
    Doubles mean = observed_mean(q, fx, fy);
    if (!hn::AllFalse(kInts, any_unobserved(quads))) mean = partial_mean(q, fx, fy, mean);
    mean = hn::IfThenElse(within, mean, hn::Set(kDoubles, double{kUnobserved}));
    const auto cells = hn::DemoteTo(kBytes, hn::DemoteTo(kInts, mean));
    if (col + step <= last) {
      hn::StoreU(cells, kBytes, out + col);
    } else {
      Cell rest[8] = {};
      hn::StoreU(cells, kBytes, rest);
      for (int i = 0; i < last - col; ++i) out[col + i] = rest[i];
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace roadfix
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include <algorithm>
#include <cmath>

namespace roadfix {

HWY_EXPORT(sample_row);

namespace {

struct Range {
  int first = 0;
  int last = 0;  ///< behind the last one
};

/// Narrowed to about where -1 < start + (col + 0.5) * step < size + 1.
Range narrowed(Range range, double start, double step, double size) {
  constexpr double kFlat = 1e-6;
  if (std::abs(step) < kFlat) return range;
  const double a = (-1.0 - start) / step;
  const double b = (size + 1.0 - start) / step;
  const auto bounded = [&](double col) {
    return static_cast<int>(std::clamp(col, static_cast<double>(range.first), static_cast<double>(range.last)));
  };
  return {bounded(std::floor(std::min(a, b)) - 1.0), bounded(std::ceil(std::max(a, b)) + 1.0)};
}

}  // namespace

BilinearSource::BilinearSource(const CellArray& cells)
    : cols_(cells.cols()),
      rows_(cells.rows()),
      quads_(static_cast<std::size_t>(cols_ + 1) * static_cast<std::size_t>(rows_ + 1)) {
  CellArray framed(cols_ + 2, rows_ + 2);
  paste(cells, framed, 1, 1);
  for (int row = 0; row <= rows_; ++row) {
    const Cell* above = framed.row(row).data();
    const Cell* below = framed.row(row + 1).data();
    std::int32_t* out = quads_.data() + static_cast<std::ptrdiff_t>(row) * (cols_ + 1);
    for (int col = 0; col <= cols_; ++col) {
      const auto quad = static_cast<std::uint32_t>(above[col]) | static_cast<std::uint32_t>(above[col + 1]) << 8U |
                        static_cast<std::uint32_t>(below[col]) << 16U |
                        static_cast<std::uint32_t>(below[col + 1]) << 24U;
      out[col] = static_cast<std::int32_t>(quad);
    }
  }
}

CellArray BilinearSource::sampled(const Placement& placement, int cols, int rows) const {
  CellArray result(cols, rows);
  const QuadPlane plane{quads_.data(), cols_, rows_};
  for (int row = 0; row < rows; ++row) {
    const GridGeometry::CellPosition start = placement.source_of(0.0, row + 0.5);
    Range range{0, cols};
    range = narrowed(range, start.col, placement.right.col, cols_);
    range = narrowed(range, start.row, placement.right.row, rows_);
    HWY_DYNAMIC_DISPATCH(sample_row)(plane, placement, row, range.first, range.last, result.row(row).data());
  }
  return result;
}

}  // namespace roadfix

#endif  // HWY_ONCE
