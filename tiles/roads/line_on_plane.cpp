#include "tiles/roads/line_on_plane.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace roadfix {
namespace {

/// Coordinates of a file, which become those of the plane.
struct Points {
  std::vector<double> x;
  std::vector<double> y;

  void add(double east, double north) {
    x.push_back(east);
    y.push_back(north);
  }

  /// Whether all of them have a place there.
  bool transform(OGRCoordinateTransformation& to_plane) {
    std::vector<int> good(x.size(), FALSE);
    OCTTransformEx(OGRCoordinateTransformation::ToHandle(&to_plane), static_cast<int>(x.size()), x.data(), y.data(),
                   nullptr, good.data());
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (good[i] == FALSE || !std::isfinite(x[i]) || !std::isfinite(y[i])) return false;
    }
    return true;
  }
};

/// One for most edges; what no map holds is not followed for ever.
int pieces_of(double length_m, double longest_m) {
  constexpr double kMost = 10'000.0;
  return static_cast<int>(std::clamp(std::ceil(length_m / longest_m), 1.0, kMost));
}

/// Eastward difference, the shorter way around in degrees.
double difference_in_x(double from, double to, OGRCoordinateTransformation& to_plane) {
  constexpr double kTurn = 360.0;
  const double difference = to - from;
  if (std::abs(difference) <= kTurn / 2.0) return difference;
  const OGRSpatialReference* crs = to_plane.GetSourceCS();
  return crs != nullptr && crs->IsGeographic() != 0 ? std::remainder(difference, kTurn) : difference;
}

/// Points that cut the edge after corner `i` into pieces of equal length.
Points points_within(const OGRSimpleCurve& line, int i, int pieces, OGRCoordinateTransformation& to_plane) {
  const double x = line.getX(i);
  const double y = line.getY(i);
  const double dx = difference_in_x(x, line.getX(i + 1), to_plane);
  const double dy = line.getY(i + 1) - y;
  Points points;
  for (int piece = 1; piece < pieces; ++piece) points.add(x + dx * piece / pieces, y + dy * piece / pieces);
  return points;
}

}  // namespace

std::optional<std::vector<GridPoint>> line_on_plane(const OGRSimpleCurve& line, OGRCoordinateTransformation& to_plane,
                                                    double longest_m) {
  const int count = line.getNumPoints();
  Points corners;
  for (int i = 0; i < count; ++i) corners.add(line.getX(i), line.getY(i));
  if (count == 0 || !corners.transform(to_plane)) return std::nullopt;
  std::vector<GridPoint> result{{corners.x[0], corners.y[0]}};
  result.reserve(corners.x.size());
  for (int i = 0; i + 1 < count; ++i) {
    const auto next = static_cast<std::size_t>(i + 1);
    const GridPoint from = result.back();
    const GridPoint to{corners.x[next], corners.y[next]};
    const int pieces = pieces_of(std::hypot(to.east_m - from.east_m, to.north_m - from.north_m), longest_m);
    if (pieces > 1) {
      Points between = points_within(line, i, pieces, to_plane);
      const bool placed = between.transform(to_plane);
      for (std::size_t k = 0; placed && k < between.x.size(); ++k) result.push_back({between.x[k], between.y[k]});
    }
    result.push_back(to);
  }
  return result;
}

}  // namespace roadfix
