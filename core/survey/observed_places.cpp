#include "core/survey/observed_places.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/match/deadline.hpp"

namespace roadfix {
namespace {

constexpr double kCoarsestCellM = 4096.0;  // of what a map file reads

/// Rectangles of a division, from one of them on.
struct Part {
  std::int64_t col = 0;
  std::int64_t row = 0;
  std::int64_t cols = 1;
  std::int64_t rows = 1;
};

/// What was observed of the cells whose centres lie in the box.
double observed_share(const RoadGrid& grid, const GridBox& box) {
  std::int64_t all = 0;
  std::int64_t observed = 0;
  for (int row = 0; row < grid.geometry.rows; ++row) {
    for (int col = 0; col < grid.geometry.cols; ++col) {
      const GridPoint centre = grid.geometry.cell_center(col, row);
      if (!box.contains(centre)) continue;
      ++all;
      observed += is_observed(grid.cells.at(col, row)) ? 1 : 0;
    }
  }
  return all > 0 ? static_cast<double>(observed) / static_cast<double>(all) : 0.0;
}

class PlaceFinder {
 public:
  PlaceFinder(const MapView& map, double footprint_m, double min_share, std::stop_token stop)
      : map_(map),
        footprint_m_(footprint_m),
        min_share_(min_share),
        stop_(std::move(stop)),
        whole_{0, 0, count(map.extent.width_m()), count(map.extent.height_m())},
        width_m_(map.extent.width_m() / static_cast<double>(whole_.cols)),
        height_m_(map.extent.height_m() / static_cast<double>(whole_.rows)) {}

  ObservedPlaces find() && {
    look_at(whole_);
    return std::move(found_);
  }

 private:
  std::int64_t count(double length_m) const { return std::max<std::int64_t>(1, std::llround(length_m / footprint_m_)); }

  GridBox box_of(const Part& part) const {
    const double west = map_.extent.min.east_m + width_m_ * static_cast<double>(part.col);
    const double north = map_.extent.max.north_m - height_m_ * static_cast<double>(part.row);
    return {{west, north - height_m_ * static_cast<double>(part.rows)},
            {west + width_m_ * static_cast<double>(part.cols), north}};
  }

  /// Around the part, as far as footprints reach, in cells of `cell_m` or a little less.
  RoadGrid read_around(const Part& part, double cell_m) const {
    double of_overview = map_.cell_m;
    while (2.0 * of_overview <= std::min(cell_m, kCoarsestCellM)) of_overview *= 2.0;
    return map_.read(GridGeometry::covering(grown(box_of(part), footprint_m_ / 2.0), of_overview));
  }

  /// Halves the longer side: what is found in turn lies side by side.
  void look_at(const Part& part) {
    require_not_stopped(stop_);
    if (part.cols * part.rows == 1) return take(part);
    constexpr double kCellsAcross = 64.0;
    const GridBox box = box_of(part);
    const double coarse_m = std::max(box.width_m(), box.height_m()) / kCellsAcross;
    if (!read_around(part, coarse_m).cells.any_observed()) return;
    Part first = part;
    Part second = part;
    if (part.cols >= part.rows) {
      first.cols = part.cols / 2;
      second.col += first.cols;
      second.cols -= first.cols;
    } else {
      first.rows = part.rows / 2;
      second.row += first.rows;
      second.rows -= first.rows;
    }
    look_at(first);
    look_at(second);
  }

  void take(const Part& rectangle) {
    constexpr double kCellsOfFootprint = 32.0;
    const RoadGrid ground = read_around(rectangle, footprint_m_ / kCellsOfFootprint);
    const GridBox box = box_of(rectangle);
    const GridPoint middle = box.centre();
    if (observed_share(ground, grown({middle, middle}, footprint_m_ / 2.0)) < min_share_) return;
    found_.places.push_back(middle);
    found_.ground_m2 += width_m_ * height_m_ * observed_share(ground, box);
  }

  const MapView& map_;
  double footprint_m_;
  double min_share_;
  std::stop_token stop_;
  Part whole_;
  double width_m_;
  double height_m_;
  ObservedPlaces found_;
};

}  // namespace

ObservedPlaces observed_places(const MapView& map, double footprint_m, double min_share, std::stop_token stop) {
  if (map.extent.empty()) return {};
  return PlaceFinder(map, footprint_m, min_share, std::move(stop)).find();
}

}  // namespace roadfix
