#include "tiles/store/fusion.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <vector>

namespace roadfix {
namespace {

/// Log-odds as integers: their sum is exact and therefore the same in every order.
constexpr double kUnitsPerNat = 1 << 20;

std::array<std::int64_t, kRoad + 1> make_log_odds() {
  std::array<std::int64_t, kRoad + 1> table{};
  for (std::size_t k = 0; k < table.size(); ++k) {
    const double p = std::clamp(static_cast<double>(k) / kRoad, 0.25 / kRoad, 1.0 - 0.25 / kRoad);
    table[k] = std::llround(std::log(p / (1.0 - p)) * kUnitsPerNat);
  }
  return table;
}

Cell cell_from_log_odds(double units) { return cell_from_probability(1.0 / (1.0 + std::exp(-units / kUnitsPerNat))); }

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
    out[i] = count < 2 ? only : cell_from_log_odds(static_cast<double>(sum) / static_cast<double>(count));
  }
  return result;
}

}  // namespace roadfix
