// The square root of a covariance, for drawing from a normal distribution.
#pragma once

#include <array>
#include <optional>

namespace roadfix {

using Matrix3 = std::array<std::array<double, 3>, 3>;

/// Lower triangular L with L L^T = covariance; rows of a direction without spread are 0. nullopt unless the matrix is
/// symmetric and positive semi-definite, to a billionth of its largest variance.
std::optional<Matrix3> cholesky(const Matrix3& covariance);

}  // namespace roadfix
