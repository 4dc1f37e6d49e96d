#include "cli/bench/agreement_picture.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

#include "cli/evaluation/panels.hpp"
#include "core/grid/resample.hpp"

namespace roadfix::bench {
namespace {

using evaluation::Panel;
using evaluation::strongest_of;

constexpr int kPanelPx = 320;

cv::Vec3b colour_of(double before, double after) {
  const auto level = [](double p) { return cv::saturate_cast<uchar>(255.0 * std::min(1.0, p)); };
  return {level(before), level(std::min(before, after)), level(after)};
}

/// The point of the plane above which the middle of the feature map lies when its nadir is at the pose.
GridPose centre_of(const FeatureMap& features, const GridPose& pose) {
  const double right = (features.cells.cols() / 2.0 - features.nadir.col) * features.cell_m;
  const double forward = (features.nadir.row - features.cells.rows() / 2.0) * features.cell_m;
  return moved(pose, {forward, right, {}});
}

cv::Mat ground_before(std::span<const Orthoimage> imagery, const FeatureMap& features, const GridPose& pose) {
  const GridPose centre = centre_of(features, pose);
  const Footprint footprint{features.cells.cols() * features.cell_m, features.cells.rows() * features.cell_m};
  for (const Orthoimage& ortho : imagery) {
    if (sees(ortho, centre.position)) return cut_out(ortho, centre, footprint, ortho.image.gsd_m).pixels;
  }
  return {};
}

}  // namespace

cv::Mat agreement(const CellArray& before, const CellArray& after) {
  assert(before.cols() == after.cols() && before.rows() == after.rows());
  const double max_before = strongest_of(before);
  const double max_after = strongest_of(after);
  cv::Mat picture(after.rows(), after.cols(), CV_8UC3, cv::Scalar::all(90));
  for (int row = 0; row < picture.rows; ++row) {
    for (int col = 0; col < picture.cols; ++col) {
      const Cell then = before.at(col, row);
      const Cell now = after.at(col, row);
      if (!is_observed(then) || !is_observed(now)) continue;
      picture.at<cv::Vec3b>(row, col) = colour_of(probability(then) / max_before, probability(now) / max_after);
    }
  }
  return picture;
}

CellArray map_under(const MapView& map, const FeatureMap& features, const GridPose& pose) {
  const GridPose centre = centre_of(features, pose);
  const double reach_m =
      0.5 * std::hypot(features.cells.cols(), features.cells.rows()) * features.cell_m + 2.0 * map.cell_m;
  const GridBox box = grown({centre.position, centre.position}, reach_m);
  const RoadGrid grid = map.read(GridGeometry::covering(box, map.cell_m));
  return cut_out(grid, centre, features.cells.cols(), features.cells.rows(), features.cell_m).cells;
}

cv::Mat agreement_picture(const MapView& map, std::span<const Orthoimage> imagery, const Query& query,
                          std::span<const PlacedFeatures> frames, const Answer& answer) {
  const auto nothing_in = [](const CellArray& cells) { return CellArray(cells.cols(), cells.rows(), kNoRoad); };
  const CellArray after = as_one(frames).cells;
  std::vector<Panel> panels;
  FeatureMap seen;  // from the true place
  CellArray there;
  if (query.truth) {
    seen = seen_from(*query.truth, query, frames, map);
    const cv::Mat before = ground_before(imagery, seen, on_grid(*query.truth, map.zone));
    if (!before.empty()) panels.push_back({"before", before});
  }
  if (query.view) panels.push_back({"after", query.view->image.pixels});
  if (query.truth) {
    there = map_under(map, seen, on_grid(*query.truth, map.zone));
    panels.push_back({"roads before", agreement(there, nothing_in(there))});
  }
  panels.push_back({"roads after", agreement(nothing_in(after), after)});
  if (query.truth) panels.push_back({"both, true place", agreement(there, seen.cells)});
  if (answer.best) {
    const FeatureMap guessed = seen_from(*answer.best, query, frames, map);
    const CellArray below = map_under(map, guessed, on_grid(*answer.best, map.zone));
    panels.push_back({"both, best guess", agreement(below, guessed.cells)});
  }
  return side_by_side(panels, kPanelPx);
}

}  // namespace roadfix::bench
