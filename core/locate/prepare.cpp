#include "core/locate/prepare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/grid/observed_range.hpp"
#include "core/grid/resample.hpp"
#include "core/search/search.hpp"
#include "core/units/error.hpp"
#include "core/units/index_range.hpp"

namespace roadfix {
namespace {

constexpr double kLargestSideM = 20'000.0;
constexpr int kMaxCellsAcross = 8192;
// Farther off, the smallest turn moves the footprint by more than what separates places.
constexpr double kMaxSidesOff = 3.0;

void require_usable(const FeatureMap& features) {
  if (features.cells.empty()) {
    throw InvalidInput("feature-map-empty", "the feature map has no cells: give at least one row and one column");
  }
  if (!std::isfinite(features.cell_m) || features.cell_m <= 0.0) {
    throw InvalidInput("parameter-out-of-range",
                       fmt::format("the feature map's cell size is {} m: give the side of a cell on the ground, in "
                                   "metres above 0",
                                   features.cell_m));
  }
  if (features.side_m() > kLargestSideM) {
    throw InvalidInput("feature-map-too-large",
                       fmt::format("the feature map spans {:.6g} m, more than {:.0f} m: check its cell size ({} m), or "
                                   "of several frames how far apart they are",
                                   features.side_m(), kLargestSideM, features.cell_m));
  }
}

bool is_near_nadir(const FeatureMap& features) {
  return features.off_nadir_cells() <= kMaxSidesOff * std::max(features.cells.cols(), features.cells.rows());
}

[[noreturn]] void refuse_nadir(const FeatureMap& features) {
  throw InvalidInput("nadir-out-of-range",
                     fmt::format("the point below the UAV lies {:.6g} cells from the middle of its feature map of {} x "
                                 "{} cells: check nadir_col and nadir_row, at most {:.0f} times the longer side is "
                                 "allowed, and {} cells of the map to the farthest corner",
                                 features.off_nadir_cells(), features.cells.cols(), features.cells.rows(), kMaxSidesOff,
                                 kMaxCellsAcross));
}

/// The map is read as far around a pose as the feature map reaches from its nadir: gigabytes for a small one far away.
void require_within_reach(const FeatureMap& features, double cell_m) {
  const double reach = features.off_nadir_cells() + 0.5 * std::hypot(features.cells.cols(), features.cells.rows());
  if (reach > kMaxCellsAcross * cell_m / features.cell_m) refuse_nadir(features);
}

FeatureMap nothing_observed_of(FeatureMap features) {
  features.cells = CellArray(1, 1);
  features.nadir = {0.5, 0.5};
  return features;
}

/// Without the surrounding rows and columns of unobserved cells: the size of the canvas must not matter. If what is
/// left is too far from the nadir, nothing counts as observed.
FeatureMap cropped_to_observed(const FeatureMap& features) {
  const CellArray& cells = features.cells;
  IndexRange cols{cells.cols(), 0};
  IndexRange rows{cells.rows(), 0};
  for (int row = 0; row < cells.rows(); ++row) {
    const auto seen = observed_in(cells.row(row));
    if (!seen) continue;
    cols = {std::min(cols.first, seen->first), std::max(cols.end, seen->end)};
    rows = {std::min(rows.first, row), row + 1};
  }
  if (rows.count() <= 0) return nothing_observed_of(features);
  FeatureMap result = features;
  result.cells = CellArray(cols.count(), rows.count());
  paste(cells, result.cells, -cols.first, -rows.first);
  result.nadir = {features.nadir.col - cols.first, features.nadir.row - rows.first};
  return is_near_nadir(result) ? result : nothing_observed_of(result);
}

}  // namespace

FeatureMap in_cells_of(const MapView& map, const FeatureMap& given) {
  require_usable(given);
  if (!is_near_nadir(given)) refuse_nadir(given);
  const FeatureMap features = cropped_to_observed(given);
  double cell_m = map.cell_m;
  while (2.0 * cell_m <= 1.01 * features.cell_m) cell_m *= 2.0;
  const double cells_across = features.side_m() / cell_m;
  if (cells_across > kMaxCellsAcross) {
    throw InvalidInput("feature-map-too-large",
                       fmt::format("the feature map spans {:.0f} cells of the map, more than {}: give a smaller window",
                                   cells_across, kMaxCellsAcross));
  }
  require_within_reach(features, cell_m);
  return resampled(features, cell_m);
}

void require_scale_range(double range) {
  if (range >= 0.0 && range <= kMaxScaleRange) return;
  throw InvalidInput("parameter-out-of-range",
                     fmt::format("the scale range is {}: give a share from 0 to {}", range, kMaxScaleRange));
}

void require_searchable(double area_km2, std::optional<double> limit_km2) {
  if (!limit_km2 || area_km2 <= *limit_km2) return;
  throw LimitExceeded("search-area-too-large",
                      fmt::format("the prior leaves {:.1f} km2 to search, more than the limit of {:.1f} km2: give a "
                                  "smaller circle or box",
                                  area_km2, *limit_km2));
}

}  // namespace roadfix
