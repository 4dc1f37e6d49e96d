#include "core/search/peak.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/match/footprint.hpp"
#include "core/match/kernel.hpp"
#include "core/match/score.hpp"
#include "core/search/ground_around.hpp"

namespace roadfix {
namespace {

/// Calls visit(col, row, bin, score) for all poses around.
template <typename Visit>
void for_each_pose(const PeakScores& scores, Visit visit) {
  for (int bin = -kPeakRadius; bin <= kPeakRadius; ++bin) {
    for (int row = -kPeakRadius; row <= kPeakRadius; ++row) {
      for (int col = -kPeakRadius; col <= kPeakRadius; ++col) visit(col, row, bin, scores.at(col, row, bin));
    }
  }
}

/// Top of the parabola through three scores, the middle one the largest.
double vertex(double before, double middle, double after) {
  const double bend = 2.0 * middle - before - after;
  return bend > 0.0 ? std::clamp(0.5 * (after - before) / bend, -0.5, 0.5) : 0.0;
}

}  // namespace

Peak peak_around(const Level& level, const HeadingBins& bins, const LatticePose& pose) {
  const LevelFeatures features = level.at_scale(pose.scale_step);
  const MapPlane plane(level.read(window_around(level, pose, kPeakRadius)).cells);
  const std::vector<PlaneCell> places = places_around({plane.cols() / 2, plane.rows() / 2}, kPeakRadius);
  std::vector<MatchSums> sums(places.size());
  Peak peak;
  for (int bin = -kPeakRadius; bin <= kPeakRadius; ++bin) {
    match_sums(plane, footprint_at(features.rotator, bins.heading(bins.wrapped(pose.bin + bin))), places, sums);
    std::size_t place = 0;
    for (int row = -kPeakRadius; row <= kPeakRadius; ++row) {
      for (int col = -kPeakRadius; col <= kPeakRadius; ++col, ++place) {
        peak.scores.at(col, row, bin) = score_of(sums[place], features.cells);
      }
    }
    if (bin == 0) peak.centre = sums[sums.size() / 2];
  }
  return peak;
}

std::array<int, 3> highest(const PeakScores& scores) {
  std::array<int, 3> best{};
  double best_score = scores.at(0, 0, 0);
  for_each_pose(scores, [&](int col, int row, int bin, double score) {
    if (score <= best_score) return;
    best_score = score;
    best = {col, row, bin};
  });
  return best;
}

PeakShape shape_of(const PeakScores& scores, const ScoreBackground& background) {
  PeakShape shape;
  const double top = scores.at(0, 0, 0);
  shape.offset = {vertex(scores.at(-1, 0, 0), top, scores.at(1, 0, 0)),
                  vertex(scores.at(0, -1, 0), top, scores.at(0, 1, 0)),
                  vertex(scores.at(0, 0, -1), top, scores.at(0, 0, 1))};
  const double top_likelihood = background.log_likelihood(top);
  double total = 0.0;
  for_each_pose(scores, [&](int col, int row, int bin, double score) {
    const double weight = std::exp(background.log_likelihood(score) - top_likelihood);
    total += weight;
    const std::array<double, 3> d{col - shape.offset[0], row - shape.offset[1], bin - shape.offset[2]};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) shape.covariance[i][j] += weight * d[i] * d[j];
    }
  });
  for (auto& row : shape.covariance) {
    for (double& value : row) value /= total;
  }
  return shape;
}

}  // namespace roadfix
