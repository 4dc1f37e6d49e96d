#include "core/search/nearby_peak.hpp"

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "core/match/footprint.hpp"
#include "core/match/kernel.hpp"
#include "core/match/score.hpp"
#include "core/search/ground_around.hpp"

namespace roadfix {
namespace {

constexpr double kStepM = 4.0;

/// Scores at places in a square of (2 reach + 1)^2 steps, row by row, the place itself in the middle.
class ScoresAround {
 public:
  ScoresAround(const Level& level, const LatticePose& place, int step, int reach) : reach_(reach) {
    const MapPlane plane(level.read(window_around(level, place, reach * step)).cells);
    const std::vector<PlaneCell> places = places_around({plane.cols() / 2, plane.rows() / 2}, reach, step);
    const LevelFeatures features = level.at_scale(place.scale_step);
    std::vector<MatchSums> sums(places.size());
    match_sums(plane, footprint_at(features.rotator, level.bins.heading(place.bin)), places, sums);
    for (const MatchSums& of_place : sums) {
      scores_.push_back(score_of(of_place, features.cells));
    }
  }

  double at(int col, int row) const {
    return scores_[static_cast<std::size_t>((row + reach_) * (2 * reach_ + 1) + col + reach_)];
  }

  /// None of the eight around it is higher.
  bool is_peak(int col, int row) const {
    for (int down = -1; down <= 1; ++down) {
      for (int right = -1; right <= 1; ++right) {
        if (at(col + right, row + down) > at(col, row)) return false;
      }
    }
    return true;
  }

 private:
  int reach_;
  std::vector<double> scores_;
};

}  // namespace

std::optional<LatticePose> nearby_peak(const Level& level, const LatticePose& place, double apart_m) {
  const int step = std::max(1, static_cast<int>(kStepM / level.cell_m()));
  const int apart = static_cast<int>(apart_m / (step * level.cell_m()));
  const ScoresAround scores(level, place, step, apart + 1);
  std::optional<LatticePose> best;
  for (int row = -apart; row <= apart; ++row) {
    for (int col = -apart; col <= apart; ++col) {
      const bool own = std::abs(col) <= 1 && std::abs(row) <= 1;
      if (own || col * col + row * row > apart * apart) continue;
      const double score = scores.at(col, row);
      if (score <= (best ? best->score : 0.0) || !scores.is_peak(col, row)) continue;
      best = {{place.cell.col + col * step, place.cell.row + row * step}, place.bin, score, place.scale_step};
    }
  }
  return best;
}

}  // namespace roadfix
