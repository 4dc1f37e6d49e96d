#include "core/geodesy/local_projection.hpp"

#include <cmath>
#include <numbers>

namespace roadfix {
namespace {

// A box pays for its polynomials with 25 projections.
constexpr int kAskedOften = 25;

/// T_0 ... T_4 of Chebyshev.
std::array<double, 5> chebyshev(double x) {
  const double x2 = x * x;
  return {1.0, x, 2.0 * x2 - 1.0, (4.0 * x2 - 3.0) * x, 8.0 * x2 * (x2 - 1.0) + 1.0};
}

std::optional<ProjectedPoint> exactly(const UtmZone& zone, LatLon point) {
  const auto projected = zone.project_if_defined(point);
  if (!projected) return std::nullopt;
  return ProjectedPoint{*projected, zone.convergence(*projected)};
}

}  // namespace

std::optional<LocalProjection> LocalProjection::over(const UtmZone& zone, LatLon south_west) {
  LocalProjection result(south_west);
  std::array<double, kTerms> nodes{};
  for (std::size_t i = 0; i < kTerms; ++i) {
    nodes[i] = std::cos(std::numbers::pi * (static_cast<double>(i) + 0.5) / double{kTerms});
  }
  for (const double y : nodes) {
    for (const double x : nodes) {
      const LatLon at{south_west.lat_deg + 0.5 * kSideDeg * (y + 1.0), south_west.lon_deg + 0.5 * kSideDeg * (x + 1.0)};
      const auto exact = exactly(zone, at);
      if (!exact) return std::nullopt;
      // Discrete orthogonality: each coefficient is the mean of the values times its polynomial, twice that but for
      // T_0.
      const auto along_lat = chebyshev(y);
      const auto along_lon = chebyshev(x);
      for (std::size_t i = 0; i < kTerms; ++i) {
        for (std::size_t j = 0; j < kTerms; ++j) {
          const double share =
              along_lat[i] * along_lon[j] * (i > 0 ? 2.0 : 1.0) * (j > 0 ? 2.0 : 1.0) / double{kTerms * kTerms};
          result.east_[i][j] += share * exact->point.east_m;
          result.north_[i][j] += share * exact->point.north_m;
          result.convergence_[i][j] += share * exact->convergence.radians();
        }
      }
    }
  }
  return result;
}

ProjectedPoint LocalProjection::at(LatLon point) const {
  const auto along_lat = chebyshev((point.lat_deg - south_west_.lat_deg) / (0.5 * kSideDeg) - 1.0);
  const auto along_lon = chebyshev((point.lon_deg - south_west_.lon_deg) / (0.5 * kSideDeg) - 1.0);
  const auto sum = [&](const Terms& terms) {
    double result = 0.0;
    for (std::size_t i = 0; i < kTerms; ++i) {
      double row = 0.0;
      for (std::size_t j = 0; j < kTerms; ++j) row += terms[i][j] * along_lon[j];
      result += row * along_lat[i];
    }
    return result;
  };
  return {{sum(east_), sum(north_)}, Angle::radians(sum(convergence_))};
}

PointProjector::Box& PointProjector::box_of(BoxIndex index) {
  if (last_ == boxes_.end() || last_->first != index) last_ = boxes_.try_emplace(index).first;
  return last_->second;
}

std::optional<ProjectedPoint> PointProjector::operator()(LatLon point) {
  constexpr double kPole = 90.0;  // a box begins at it that lies beyond
  constexpr double kTurn = 360.0;
  if (!(std::abs(point.lat_deg) < kPole) || !(std::abs(point.lon_deg) <= kTurn)) return exactly(zone_, point);
  const double row = std::floor(point.lat_deg / LocalProjection::kSideDeg);
  const double col = std::floor(point.lon_deg / LocalProjection::kSideDeg);
  Box& box = box_of({static_cast<int>(row), static_cast<int>(col)});
  if (++box.asked == kAskedOften) {
    box.local = LocalProjection::over(zone_, {row * LocalProjection::kSideDeg, col * LocalProjection::kSideDeg});
  }
  return box.local ? box.local->at(point) : exactly(zone_, point);
}

}  // namespace roadfix
