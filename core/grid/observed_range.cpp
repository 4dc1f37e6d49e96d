#include "core/grid/observed_range.hpp"

#include <algorithm>

namespace roadfix {

std::optional<IndexRange> observed_in(std::span<const Cell> row) {
  const auto first = std::ranges::find_if(row, is_observed);
  if (first == row.end()) return std::nullopt;
  const auto last = std::find_if(row.rbegin(), row.rend(), is_observed);
  return IndexRange{static_cast<int>(first - row.begin()), static_cast<int>(last.base() - row.begin())};
}

}  // namespace roadfix
