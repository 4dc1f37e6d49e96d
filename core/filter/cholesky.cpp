#include "core/filter/cholesky.hpp"

#include <algorithm>
#include <cmath>

namespace roadfix {

namespace {

constexpr double kRounding = 1e-6;  // of what came as numbers of single precision
constexpr double kNoSpread = 1e-9;  // m or rad

/// What each row is told in units of: metres and radians do not compare.
std::array<double, 3> scales_of(const Matrix3& c) {
  const double place = std::sqrt(std::max({c[0][0], c[1][1], kNoSpread * kNoSpread}));
  return {place, place, std::sqrt(std::max(c[2][2], kNoSpread * kNoSpread))};
}

/// Of a covariance without units: of variances that compare, the largest is 1.
std::optional<Matrix3> factor_of_scaled(const Matrix3& c) {
  Matrix3 factor{};
  for (std::size_t j = 0; j < 3; ++j) {
    double rest = c[j][j];
    for (std::size_t k = 0; k < j; ++k) rest -= factor[j][k] * factor[j][k];
    if (!(rest >= -kRounding)) return std::nullopt;
    const bool is_flat = rest <= kRounding;
    factor[j][j] = is_flat ? 0.0 : std::sqrt(rest);
    for (std::size_t i = j + 1; i < 3; ++i) {
      if (!(std::abs(c[i][j] - c[j][i]) <= kRounding)) return std::nullopt;
      double shared = c[i][j];
      for (std::size_t k = 0; k < j; ++k) shared -= factor[i][k] * factor[j][k];
      // A direction without spread can share none.
      if (is_flat && shared * shared > 4.0 * kRounding * std::max(c[i][i], kRounding)) return std::nullopt;
      factor[i][j] = is_flat ? 0.0 : shared / factor[j][j];
    }
  }
  return factor;
}

}  // namespace

std::optional<Matrix3> cholesky(const Matrix3& c) {
  const std::array<double, 3> scale = scales_of(c);
  Matrix3 scaled{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) scaled[i][j] = c[i][j] / scale[i] / scale[j];
  }
  auto factor = factor_of_scaled(scaled);
  if (!factor) return std::nullopt;
  for (std::size_t i = 0; i < 3; ++i) {
    for (double& value : (*factor)[i]) value *= scale[i];
  }
  return factor;
}

}  // namespace roadfix
