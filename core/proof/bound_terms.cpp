#include "core/proof/bound_terms.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/proof/bound_map.hpp"

namespace roadfix {
namespace {

constexpr std::size_t kGroups = 64;
constexpr std::size_t kMaxTermsOfGroup = 1000;  // their sum has to fit into 16 bits
constexpr double kHighestSum = 2147483648.0;

}  // namespace

BoundTerms quantized(WeightedTerms weighted, Rounding rounding) {
  BoundTerms result;
  std::erase_if(weighted, [](const auto& term) { return term.first <= 0.0; });
  if (weighted.empty()) return result;
  std::ranges::sort(weighted, [](const auto& a, const auto& b) { return a.first < b.first; });
  const double max_sum = BoundMap::kFull * weighted.back().first * static_cast<double>(weighted.size());
  result.unit = std::max(1.0, max_sum / kHighestSum);
  const std::size_t size = std::clamp<std::size_t>((weighted.size() + kGroups - 1) / kGroups, 1, kMaxTermsOfGroup);
  for (std::size_t first = 0; first < weighted.size(); first += size) {
    const std::size_t end = std::min(first + size, weighted.size());
    const double weight = weighted[rounding == Rounding::kUp ? end - 1 : first].first / result.unit;
    result.groups.push_back(
        {static_cast<std::uint32_t>(rounding == Rounding::kUp ? std::ceil(weight) : std::floor(weight)),
         static_cast<std::uint32_t>(end)});
    for (std::size_t i = first; i < end; ++i) result.terms.push_back(weighted[i].second);
  }
  return result;
}

}  // namespace roadfix
