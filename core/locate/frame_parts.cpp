#include "core/locate/frame_parts.hpp"

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

// Of correlations by chance, by which that of a part has to be less: parts of small frames differ anyway.
constexpr double kDeviations = 2.0;

struct FramePart {
  const char* name;
  bool of_rows;  ///< else of columns
  bool first;
  double share;        ///< of the observed cells
  double least_share;  ///< of the correlation of the whole
};
// The whole is about the mean of two halves: where one has less than half of it, the other fits three times as well.
// A quarter differs more from the rest, in frames of one place too.
constexpr std::array<FramePart, 8> kFrameParts{{{"left half", false, true, 0.5, 0.5},
                                                {"right half", false, false, 0.5, 0.5},
                                                {"upper half", true, true, 0.5, 0.5},
                                                {"lower half", true, false, 0.5, 0.5},
                                                {"left quarter", false, true, 0.25, 1.0 / 3.0},
                                                {"right quarter", false, false, 0.25, 1.0 / 3.0},
                                                {"upper quarter", true, true, 0.25, 1.0 / 3.0},
                                                {"lower quarter", true, false, 0.25, 1.0 / 3.0}}};

/// How many rows or columns from the first on hold that share of the observed cells.
int lines_of_first(double share, const CellArray& cells, bool of_rows) {
  std::vector<std::int64_t> observed(static_cast<std::size_t>(of_rows ? cells.rows() : cells.cols()));
  for (int row = 0; row < cells.rows(); ++row) {
    for (int col = 0; col < cells.cols(); ++col) {
      if (is_observed(cells.at(col, row))) ++observed[static_cast<std::size_t>(of_rows ? row : col)];
    }
  }
  const auto all = std::accumulate(observed.begin(), observed.end(), std::int64_t{0});
  const double wanted = share * static_cast<double>(all);
  std::int64_t counted = 0;
  int lines = 0;
  for (; static_cast<double>(counted) < wanted; ++lines) counted += observed[static_cast<std::size_t>(lines)];
  return lines;
}

FeatureMap part_of(FeatureMap frame, const FramePart& part) {
  CellArray& cells = frame.cells;
  const int lines = lines_of_first(part.first ? part.share : 1.0 - part.share, cells, part.of_rows);
  for (int row = 0; row < cells.rows(); ++row) {
    for (int col = 0; col < cells.cols(); ++col) {
      const bool in_first = (part.of_rows ? row : col) < lines;
      if (in_first != part.first) cells.at(col, row) = kUnobserved;
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

bool falls_short(const MatchSums& part, double cell_m, double whole, double least_share) {
  const std::optional<double> own = pearson(part);
  if (!own || *own >= least_share * whole) return false;
  const double chance = std::sqrt(kSampleM2 / (cell_m * cell_m * static_cast<double>(part.n)));
  return whole - *own > kDeviations * chance;
}

bool tells_a_place(const MapView& map, const FeatureMap& part, const GridPose& pose) {
  if (refusal_of(part) || shows_less_than_a_road_across(part)) return false;
  const MatchSums sums = sums_at(map, part, pose);
  return static_cast<double>(sums.n) >= footprint_cells(part).min &&
         !map_shows_less_than_a_road_across(sums, part.cell_m);
}

}  // namespace

const char* contradicting_part(const MapView& map, const FeatureMap& frame, const GridPose& pose) {
  const double whole = pearson(soft_sums(map, frame, pose)).value_or(0.0);
  for (const FramePart& part : kFrameParts) {
    const FeatureMap shown = part_of(frame, part);
    if (falls_short(soft_sums(map, shown, pose), shown.cell_m, whole, part.least_share) &&
        tells_a_place(map, shown, pose)) {
      return part.name;
    }
  }
  return nullptr;
}

}  // namespace roadfix
