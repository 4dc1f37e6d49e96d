#include "core/search/mode_finder.hpp"

#include <algorithm>
#include <array>
#include <functional>

#include "core/search/peak.hpp"

namespace roadfix {

SearchMode ModeFinder::at(LatticePose pose) const {
  constexpr int kMaxMoves = 3;
  pose.bin *= 2;
  Peak peak = peak_around(finest_, bins_, pose);
  for (int moves = 0; moves < kMaxMoves; ++moves) {
    const std::array<int, 3> top = highest(peak.scores);
    if (top == std::array<int, 3>{}) break;
    pose = {{pose.cell.col + top[0], pose.cell.row + top[1]}, pose.bin + top[2], 0.0, pose.scale_step};
    peak = peak_around(finest_, bins_, pose);
  }
  const PeakShape shape = shape_of(peak.scores, background_);
  const double cell = finest_.cell_m();
  const std::array<double, 3> unit{cell, -cell, bins_.step().radians()};  // rows grow to the south
  SearchMode mode;
  mode.pose = grid_pose_of(pose, cell, bins_);
  mode.pose.position.east_m += unit[0] * shape.offset[0];
  mode.pose.position.north_m += unit[1] * shape.offset[1];
  mode.pose.heading += Angle::radians(unit[2] * shape.offset[2]);
  mode.scale = finest_.scales.factor(pose.scale_step);
  mode.score = peak.scores.at(0, 0, 0);
  mode.pearson = pearson(peak.centre).value_or(0.0);
  mode.observed_cells = peak.centre.n;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) mode.covariance[i][j] = unit[i] * unit[j] * shape.covariance[i][j];
    mode.covariance[i][i] += unit[i] * unit[i] / 12.0;  // the lattice is no finer than that
  }
  return mode;
}

std::vector<SearchMode> ModeFinder::first_of(const std::vector<LatticePose>& poses, std::size_t count) {
  std::vector<SearchMode> modes;
  for (const LatticePose& pose : poses) {
    if (modes.size() >= count) break;
    if (deadline_.over() && !modes.empty()) {
      in_time_ = false;
      break;
    }
    const SearchMode mode = at(pose);
    const auto known = std::ranges::find_if(modes, [&](const SearchMode& other) { return on_one_peak(mode, other); });
    if (known == modes.end()) {
      modes.push_back(mode);
    } else if (mode.score > known->score) {
      *known = mode;
    }
  }
  std::ranges::stable_sort(modes, std::ranges::greater{}, &SearchMode::score);
  return modes;
}

bool ModeFinder::on_one_peak(const SearchMode& a, const SearchMode& b) const {
  return distance_m(a.pose.position, b.pose.position) <= kPeakRadius * finest_.cell_m() &&
         angular_distance(a.pose.heading, b.pose.heading) <= double{kPeakRadius} * bins_.step();
}

}  // namespace roadfix
