#include "core/grid/halving_kernel.hpp"

// clang-format off: foreach_target compiles this file once per instruction set, and must come before highway.h
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/grid/halving_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace roadfix {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::CappedTag<std::uint16_t, 16> kSums;
constexpr hn::RebindToSigned<decltype(kSums)> kSigned;
constexpr hn::Rebind<std::uint8_t, decltype(kSums)> kBytes;
using Sums = hn::Vec<decltype(kSums)>;
using Bytes = hn::Vec<decltype(kBytes)>;

/// The cells of a row in pairs.
struct Pairs {
  Bytes left, right;
};

HWY_INLINE HWY_ATTR Pairs pairs_at(const Cell* cells) {
  Pairs pairs{hn::Zero(kBytes), hn::Zero(kBytes)};
  hn::LoadInterleaved2(kBytes, cells, pairs.left, pairs.right);
  return pairs;
}

HWY_INLINE HWY_ATTR Bytes means_of(const Pairs& upper, const Pairs& lower) {
  const auto number = [](int n) HWY_ATTR { return hn::Set(kSums, static_cast<std::uint16_t>(n)); };
  const Sums one = number(1);
  const Sums unobserved = number(kUnobserved);
  Sums count = hn::Zero(kSums);
  Sums sum = count;
  for (const Bytes& bytes : {upper.left, upper.right, lower.left, lower.right}) {
    const Sums cells = hn::PromoteTo(kSums, bytes);
    const auto seen = hn::Ne(cells, unobserved);
    count = hn::Add(count, hn::IfThenElseZero(seen, one));
    sum = hn::Add(sum, hn::IfThenElseZero(seen, cells));
  }
  const Sums of_two = hn::ShiftRight<1>(hn::Add(sum, one));
  const Sums of_three = hn::MulHigh(hn::Add(sum, one), number(0x10000 / 3 + 1));  // exact up to three times 255
  const Sums of_four = hn::ShiftRight<2>(hn::Add(sum, number(2)));
  Sums mean = hn::IfThenElse(hn::Eq(count, one), sum, unobserved);
  mean = hn::IfThenElse(hn::Eq(count, number(2)), of_two, mean);
  mean = hn::IfThenElse(hn::Eq(count, number(3)), of_three, mean);
  mean = hn::IfThenElse(hn::Eq(count, number(4)), of_four, mean);
  return hn::DemoteTo(kBytes, hn::BitCast(kSigned, mean));
}

/// Returns how many means it wrote: as many of `count` as fill whole vectors.
std::size_t halve_pairs(const Cell* upper, const Cell* lower, Cell* means, std::size_t count) {
  const std::size_t step = hn::Lanes(kSums);
  std::size_t i = 0;
  for (; i + step <= count; i += step) {
    hn::StoreU(means_of(pairs_at(upper + 2 * i), pairs_at(lower + 2 * i)), kBytes, means + i);
  }
  return i;
}

}  // namespace HWY_NAMESPACE
}  // namespace roadfix
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include <algorithm>
#include <cassert>

namespace roadfix {

HWY_EXPORT(halve_pairs);

namespace {

Cell mean_at(std::span<const Cell> upper, std::span<const Cell> lower, std::size_t first) {
  int sum = 0;
  int count = 0;
  for (std::size_t col = first; col < std::min(first + 2, upper.size()); ++col) {
    for (const Cell cell : {upper[col], lower[col]}) {
      if (!is_observed(cell)) continue;
      sum += cell;
      ++count;
    }
  }
  return count > 0 ? static_cast<Cell>((sum + count / 2) / count) : kUnobserved;
}

}  // namespace

void halve_rows(std::span<const Cell> upper, std::span<const Cell> lower, std::span<Cell> means) {
  assert(upper.size() == lower.size() && means.size() == (upper.size() + 1) / 2);
  std::size_t i = HWY_DYNAMIC_DISPATCH(halve_pairs)(upper.data(), lower.data(), means.data(), upper.size() / 2);
  for (; i < means.size(); ++i) means[i] = mean_at(upper, lower, 2 * i);
}

}  // namespace roadfix

#endif  // HWY_ONCE
