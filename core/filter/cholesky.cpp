#include "core/filter/cholesky.hpp"

#include <algorithm>
#include <cmath>

namespace roadfix {

std::optional<Matrix3> cholesky(const Matrix3& c) {
  const double rounding = 1e-9 * std::max({c[0][0], c[1][1], c[2][2]});
  Matrix3 factor{};
  for (std::size_t j = 0; j < 3; ++j) {
    double rest = c[j][j];
    for (std::size_t k = 0; k < j; ++k) rest -= factor[j][k] * factor[j][k];
    if (!(rest >= -rounding)) return std::nullopt;
    const bool is_flat = rest <= rounding;
    factor[j][j] = is_flat ? 0.0 : std::sqrt(rest);
    for (std::size_t i = j + 1; i < 3; ++i) {
      if (!(std::abs(c[i][j] - c[j][i]) <= rounding)) return std::nullopt;
      double shared = c[i][j];
      for (std::size_t k = 0; k < j; ++k) shared -= factor[i][k] * factor[j][k];
      // A direction without spread can share none.
      if (is_flat && shared * shared > 4.0 * rounding * std::max(c[i][i], rounding)) return std::nullopt;
      factor[i][j] = is_flat ? 0.0 : shared / factor[j][j];
    }
  }
  return factor;
}

}  // namespace roadfix
