#include "core/match/ground_sums.hpp"

#include <algorithm>
#include <array>
#include <limits>

// clang-format off: foreach_target compiles this file once per instruction set, and must come before highway.h
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/match/ground_sums.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace roadfix {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::ptrdiff_t kEach = 2;  // numbers of a position
constexpr std::size_t kNumbers = kEach * kBlockCells;

/// Adds what lies between the ends of each run; `nadir` is that of the first position.
HWY_ATTR void sum_runs(std::span<const RowRun> runs, const std::uint64_t* nadir, std::ptrdiff_t stride,
                       std::uint64_t* out) {
  constexpr hn::CappedTag<std::uint64_t, kNumbers> kLanes;
  const std::size_t step = hn::Lanes(kLanes);
  for (std::size_t start = 0; start < kNumbers; start += step) {
    auto sum = hn::Zero(kLanes);
    for (const RowRun& run : runs) {
      const std::uint64_t* row = nadir + run.row * stride + start;
      sum =
          hn::Add(sum, hn::Sub(hn::LoadU(kLanes, row + kEach * run.last), hn::LoadU(kLanes, row + kEach * run.first)));
    }
    hn::StoreU(sum, kLanes, out + start);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace roadfix
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace roadfix {
namespace {

HWY_EXPORT(sum_runs);

constexpr int kValueBits = 32;

void include(Interval& range, std::uint64_t sum) {
  const auto value = static_cast<double>(sum);
  range = {std::min(range.min, value), std::max(range.max, value)};
}

}  // namespace

GroundSums::GroundSums(const BoundMap& map, int col, int row, int cols, int rows)
    : col_(col), row_(row), stride_(cols + 1) {
  const MapPlane& cells = map.exact();
  before_.reserve(2 * static_cast<std::size_t>(stride_) * static_cast<std::size_t>(rows));
  for (int r = row; r < row + rows; ++r) {
    std::uint64_t cells_and_values = 0;
    std::uint64_t squares = 0;
    for (int c = col; c <= col + cols; ++c) {
      before_.push_back(cells_and_values);
      before_.push_back(squares);
      if (r < 0 || c < 0 || r >= cells.rows() || c >= cells.cols() || !is_observed(*cells.at(c, r))) continue;
      const auto value = static_cast<std::uint64_t>(*cells.at(c, r) - map.base());
      cells_and_values += 1 + (value << kValueBits);
      squares += value * value;
    }
  }
}

GroundRange GroundSums::below(std::span<const RowRun> footprint, int block_col, int block_row) const {
  constexpr double kMax = std::numeric_limits<double>::max();
  GroundRange range{{kMax, 0.0}, {kMax, 0.0}, {kMax, 0.0}};
  for (int i = 0; i < kBlockCells; ++i) {
    const std::ptrdiff_t col = kBlockCells * block_col - col_;
    const std::ptrdiff_t row = kBlockCells * block_row + i - row_;
    std::array<std::uint64_t, std::size_t{2} * kBlockCells> sums{};
    HWY_DYNAMIC_DISPATCH(sum_runs)(footprint, before_.data() + 2 * (row * stride_ + col), 2 * stride_, sums.data());
    for (std::size_t k = 0; k < sums.size(); k += 2) {
      include(range.cells, sums[k] & std::numeric_limits<std::uint32_t>::max());
      include(range.value, sums[k] >> kValueBits);
      include(range.square, sums[k + 1]);
    }
  }
  return range;
}

}  // namespace roadfix

#endif  // HWY_ONCE
