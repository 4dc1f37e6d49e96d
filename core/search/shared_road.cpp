#include "core/search/shared_road.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>

namespace roadfix {

double shared_road_cells(const CellArray& map, const CellArray& features) {
  assert(map.cells().size() == features.cells().size());
  const auto for_each_in_both = [&](auto use) {
    for (std::size_t i = 0; i < map.cells().size(); ++i) {
      const Cell m = map.cells()[i];
      const Cell l = features.cells()[i];
      if (is_observed(m) && is_observed(l)) use(probability(m), probability(l));
    }
  };
  double n = 0.0;
  double sum_m = 0.0;
  double sum_l = 0.0;
  for_each_in_both([&](double m, double l) {
    n += 1.0;
    sum_m += m;
    sum_l += l;
  });
  if (n == 0.0) return 0.0;
  double sum = 0.0;
  double squares = 0.0;
  for_each_in_both([&](double m, double l) {
    const double w = std::max(0.0, m - sum_m / n) * std::max(0.0, l - sum_l / n);
    sum += w;
    squares += w * w;
  });
  return squares > 0.0 ? sum * sum / squares : 0.0;
}

}  // namespace roadfix
