// The square root of a covariance, for drawing from a normal distribution.
#pragma once

#include <array>
#include <optional>

namespace roadfix {

using Matrix3 = std::array<std::array<double, 3>, 3>;

/// Of two coordinates in metres and an angle in radians: lower triangular L with L L^T = covariance; columns of a
/// direction without spread are 0. nullopt unless the matrix is symmetric and positive semi-definite, to a millionth of
/// the largest variance in metres and of that of the angle.
std::optional<Matrix3> cholesky(const Matrix3& covariance);

}  // namespace roadfix
