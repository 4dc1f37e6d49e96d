#include "tiles/store/fusion.hpp"

#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>

#include "core/grid/log_odds.hpp"

namespace roadfix {
namespace {

/// Log-odds as integers: their sum is exact and therefore the same in every order.
constexpr double kUnitsPerNat = 1 << 20;

std::array<std::int64_t, kRoad + 1> make_log_odds() {
  std::array<std::int64_t, kRoad + 1> table{};
  for (std::size_t k = 0; k < table.size(); ++k) {
    table[k] = std::llround(log_odds(static_cast<Cell>(k)) * kUnitsPerNat);
  }
  return table;
}

}  // namespace

CellArray fused(std::span<const CellArray> sources) {
  static const auto kLogOdds = make_log_odds();
  assert(!sources.empty());
  CellArray result = sources.front();
  if (sources.size() == 1) return result;
  const auto out = result.cells();
  for (std::size_t i = 0; i < out.size(); ++i) {
    std::int64_t sum = 0;
    std::int64_t count = 0;
    Cell only = kUnobserved;
    for (const CellArray& source : sources) {
      const Cell cell = source.cells()[i];
      if (!is_observed(cell)) continue;
      sum += kLogOdds[cell];
      ++count;
      only = cell;
    }
    out[i] =
        count < 2 ? only : cell_from_log_odds(static_cast<double>(sum) / static_cast<double>(count) / kUnitsPerNat);
  }
  return result;
}

}  // namespace roadfix
