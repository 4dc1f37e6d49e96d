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

/// A parabola through the middle and its neighbours along and between the axes.
struct Parabola {
  std::array<double, 3> slope{};  ///< in the middle
  std::array<std::array<double, 3>, 3> bend{};
};

Parabola parabola_of(const PeakScores& scores) {
  const auto at = [&](std::size_t i, int along_i, std::size_t j, int along_j) {
    std::array<int, 3> pose{};
    pose[i] += along_i;
    pose[j] += along_j;
    return scores.at(pose[0], pose[1], pose[2]);
  };
  Parabola parabola;
  for (std::size_t i = 0; i < 3; ++i) {
    parabola.slope[i] = 0.5 * (at(i, 1, i, 0) - at(i, -1, i, 0));
    for (std::size_t j = 0; j < 3; ++j) {
      parabola.bend[i][j] = i == j ? at(i, 1, i, 0) + at(i, -1, i, 0) - 2.0 * scores.at(0, 0, 0)
                                   : 0.25 * (at(i, 1, j, 1) + at(i, -1, j, -1) - at(i, 1, j, -1) - at(i, -1, j, 1));
    }
  }
  return parabola;
}

/// Within +-0.5 on each axis, by coordinate ascent. All axes together: along a road, or where a turn makes up for a
/// step aside, the top of each axis by itself lies elsewhere.
std::array<double, 3> top_of(const Parabola& parabola) {
  constexpr int kRounds = 50;
  std::array<double, 3> offset{};
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t i = 0; i < 3; ++i) {
      const double bend = parabola.bend[i][i];
      if (bend >= 0.0) continue;  // flat, since the middle holds the largest score
      double slope = parabola.slope[i];
      for (std::size_t j = 0; j < 3; ++j) slope += j == i ? 0.0 : parabola.bend[i][j] * offset[j];
      offset[i] = std::clamp(-slope / bend, -0.5, 0.5);
    }
  }
  return offset;
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
  shape.offset = top_of(parabola_of(scores));
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
