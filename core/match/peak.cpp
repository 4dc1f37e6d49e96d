#include "core/match/peak.hpp"

#include <algorithm>
#include <cmath>

namespace roadfix {
namespace {

double at(const PeakScores& scores, int col, int row, int bin) {
  const auto index = [](int i) { return static_cast<std::size_t>(i + kPeakRadius); };
  return scores[index(bin)][index(row)][index(col)];
}

/// Calls visit(col, row, bin, score) for all poses around.
template <typename Visit>
void for_each_pose(const PeakScores& scores, Visit visit) {
  for (int bin = -kPeakRadius; bin <= kPeakRadius; ++bin) {
    for (int row = -kPeakRadius; row <= kPeakRadius; ++row) {
      for (int col = -kPeakRadius; col <= kPeakRadius; ++col) visit(col, row, bin, at(scores, col, row, bin));
    }
  }
}

/// Top of the parabola through three scores, the middle one the largest.
double vertex(double before, double middle, double after) {
  const double bend = 2.0 * middle - before - after;
  return bend > 0.0 ? std::clamp(0.5 * (after - before) / bend, -0.5, 0.5) : 0.0;
}

}  // namespace

std::array<int, 3> highest(const PeakScores& scores) {
  std::array<int, 3> best{};
  double best_score = at(scores, 0, 0, 0);
  for_each_pose(scores, [&](int col, int row, int bin, double score) {
    if (score <= best_score) return;
    best_score = score;
    best = {col, row, bin};
  });
  return best;
}

PeakShape shape_of(const PeakScores& scores, const ScoreBackground& background) {
  PeakShape shape;
  const double top = at(scores, 0, 0, 0);
  shape.offset = {vertex(at(scores, -1, 0, 0), top, at(scores, 1, 0, 0)),
                  vertex(at(scores, 0, -1, 0), top, at(scores, 0, 1, 0)),
                  vertex(at(scores, 0, 0, -1), top, at(scores, 0, 0, 1))};
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
