#include "core/locate/frame_halves.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <vector>

#include "core/locate/footprint_refusal.hpp"
#include "core/locate/match_poses.hpp"
#include "core/locate/search_figures.hpp"
#include "core/locate/soft_map.hpp"
#include "core/match/correlation.hpp"
#include "core/match/score.hpp"
#include "core/search/shared_road.hpp"

namespace roadfix {
namespace {

// Of the correlation of the whole, which is about the mean of two halves: the other one fits three times as well.
constexpr double kLeastShare = 0.5;
// Of correlations by chance, by which it has to be less: halves of small frames differ anyway.
constexpr double kDeviations = 2.0;

struct Half {
  const char* name;
  bool of_rows;  ///< else of columns
  bool first;
};
constexpr std::array<Half, 4> kHalves{
    {{"left", false, true}, {"right", false, false}, {"upper", true, true}, {"lower", true, false}}};

/// How many rows or columns from the first on hold half of the observed cells.
int lines_of_first_half(const CellArray& cells, bool of_rows) {
  std::vector<std::int64_t> observed(static_cast<std::size_t>(of_rows ? cells.rows() : cells.cols()));
  for (int row = 0; row < cells.rows(); ++row) {
    for (int col = 0; col < cells.cols(); ++col) {
      if (is_observed(cells.at(col, row))) ++observed[static_cast<std::size_t>(of_rows ? row : col)];
    }
  }
  const auto all = std::accumulate(observed.begin(), observed.end(), std::int64_t{0});
  std::int64_t counted = 0;
  int lines = 0;
  for (; 2 * counted < all; ++lines) counted += observed[static_cast<std::size_t>(lines)];
  return lines;
}

FeatureMap half_of(FeatureMap frame, const Half& half) {
  CellArray& cells = frame.cells;
  const int lines = lines_of_first_half(cells, half.of_rows);
  for (int row = 0; row < cells.rows(); ++row) {
    for (int col = 0; col < cells.cols(); ++col) {
      const bool in_first = (half.of_rows ? row : col) < lines;
      if (in_first != half.first) cells.at(col, row) = kUnobserved;
    }
  }
  return frame;
}

bool map_shows_less_than_a_road_across(const MatchSums& sums, double cell_m) {
  return cell_m * cell_m * sums.m < kRoadWidthM * cell_m * std::sqrt(static_cast<double>(sums.n));
}

/// By what the search compares.
MatchSums soft_sums(const MapView& map, const FeatureMap& part, const GridPose& pose) {
  return sums_at(soft_view(map), softened(part), pose);
}

bool falls_short(const MatchSums& half, double cell_m, double whole) {
  const std::optional<double> own = pearson(half);
  if (!own || *own >= kLeastShare * whole) return false;
  const double chance = std::sqrt(kSampleM2 / (cell_m * cell_m * static_cast<double>(half.n)));
  return whole - *own > kDeviations * chance;
}

bool tells_a_place(const MapView& map, const FeatureMap& part, const GridPose& pose) {
  if (refusal_of(part) || shows_less_than_a_road_across(part)) return false;
  const MatchSums sums = sums_at(map, part, pose);
  return static_cast<double>(sums.n) >= footprint_cells(part).min &&
         !map_shows_less_than_a_road_across(sums, part.cell_m);
}

}  // namespace

const char* contradicting_half(const MapView& map, const FeatureMap& frame, const GridPose& pose) {
  const double whole = pearson(soft_sums(map, frame, pose)).value_or(0.0);
  for (const Half& half : kHalves) {
    const FeatureMap part = half_of(frame, half);
    if (falls_short(soft_sums(map, part, pose), part.cell_m, whole) && tells_a_place(map, part, pose)) return half.name;
  }
  return nullptr;
}

}  // namespace roadfix
