#include "tiles/roads/bare_rim.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tiles/roads/line_boxes.hpp"

namespace roadfix {
namespace {

constexpr double kSquareSideM = 1000.0;
constexpr double kMostSquares = 1000.0;  // on a side

/// Squares of a box, and one more on each side, from which all others can be reached.
class BareSquares {
 public:
  explicit BareSquares(const GridBox& box)
      : corner_(box.min),
        side_m_(std::max(kSquareSideM, std::max(box.width_m(), box.height_m()) / kMostSquares)),
        squares_(count(box.height_m()) + 2, count(box.width_m()) + 2, CV_8UC1, cv::Scalar(kBare)) {}

  void add(GridPoint from, GridPoint to) {
    constexpr double kStepsOfASide = 4.0;
    constexpr double kMostSteps = 1e4;  // to a point of no place
    const double length_m = std::hypot(to.east_m - from.east_m, to.north_m - from.north_m);
    const auto steps = static_cast<int>(std::min(kMostSteps, std::ceil(kStepsOfASide * length_m / side_m_))) + 1;
    for (int i = 0; i <= steps; ++i) {
      const double share = static_cast<double>(i) / steps;
      add({from.east_m + share * (to.east_m - from.east_m), from.north_m + share * (to.north_m - from.north_m)});
    }
  }

  double all_km2() const { return km2((squares_.cols - 2) * (squares_.rows - 2)); }
  double bare_from_rim_km2() const {
    cv::Mat squares = squares_.clone();
    cv::floodFill(squares, cv::Point(0, 0), cv::Scalar(kReached));
    return km2(cv::countNonZero(squares == kReached) - 2 * (squares_.cols + squares_.rows) + 4);
  }

 private:
  static constexpr int kRoadThere = 0;
  static constexpr int kBare = 1;
  static constexpr int kReached = 2;

  int count(double length_m) const { return std::max(1, static_cast<int>(std::lround(length_m / side_m_))); }
  double km2(int squares) const { return squares * side_m_ * side_m_ / 1e6; }

  void add(GridPoint point) {
    const double col = std::floor((point.east_m - corner_.east_m) / side_m_);
    const double row = std::floor((point.north_m - corner_.north_m) / side_m_);
    if (!(col >= 0.0 && col < squares_.cols - 2 && row >= 0.0 && row < squares_.rows - 2)) return;
    squares_.at<std::uint8_t>(static_cast<int>(row) + 1, static_cast<int>(col) + 1) = kRoadThere;
  }

  GridPoint corner_;
  double side_m_;
  cv::Mat squares_;
};

}  // namespace

std::optional<std::string> note_on_bare_rim(const RoadNetwork& network, std::span<const RoadLine> lines) {
  constexpr std::size_t kCrossing = 200;
  constexpr double kWorthNoting = 0.25;
  constexpr double kWorthNotingKm2 = 10.0;
  constexpr double kEarthM = 4e7;
  if (lines.size() < kCrossing) return std::nullopt;
  const GridBox middle = middle_of(boxes_of(network, lines), kCrossing);
  if (!(std::max(middle.width_m(), middle.height_m()) < kEarthM)) return std::nullopt;
  BareSquares squares(middle);
  for (const RoadLine& line : lines) {
    const auto points = std::span(network.points).subspan(line.first_point, line.points);
    for (std::size_t i = 0; i + 1 < points.size(); ++i) squares.add(points[i], points[i + 1]);
  }
  const double bare_km2 = squares.bare_from_rim_km2();
  if (bare_km2 < kWorthNotingKm2 || bare_km2 < kWorthNoting * squares.all_km2()) return std::nullopt;
  return fmt::format(
      "{:.0f} of the {:.0f} km2 around its roads hold none, from the rim on, and count as ground without roads. If the "
      "extract is cut along a border, give its polygon: --extent FILE.poly or .geojson",
      bare_km2, squares.all_km2());
}

}  // namespace roadfix
