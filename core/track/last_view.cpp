#include "core/track/last_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/grid/resample.hpp"
#include "core/locate/same_view.hpp"
#include "core/match/correlation.hpp"
#include "core/units/bytes.hpp"
#include "core/units/fnv.hpp"

namespace roadfix {
namespace {

// Views are compared in cells at least so many times as large, and at most so many across: that averages the noise of
// single cells, and keeps states small.
constexpr double kCoarser = 2.0;
constexpr int kMaxAcrossCompared = 128;
static_assert(kMaxAcrossCompared <= RecentFrames::kMaxAcross, "LastView::earlier keeps no larger one");

// Pictures are compared once the vehicle has moved by so much of the ground that they show. So far apart, none of 134
// over Adiyaman, Hatay, Kahramanmaras and Massachusetts agreed (is_same_picture()) by more than 0.23. Those of a
// vehicle that leans by just as much as it moves may agree: 8 of 16,000 did, taken by a lens of 37 degrees 10 or 15 m
// apart, with 1 or 3 degrees of roll and pitch.
constexpr double kApartShare = 3.0 / PictureSketch::kAcross;
constexpr double kApartCells = 3.0;  // views are compared once roads must have moved by this
constexpr double kMinShareInCommon = 0.25;
// Laid in place over an earlier view, none of 537 views of 16 flights over Montevideo and Adiyaman correlated by more
// than 0.51. A view that stands still, with 3 % of its cells inverted, correlates by 0.9.
constexpr double kStillCorrelation = 0.75;
constexpr double kStillMargin = 0.3;  // at least so much better in place than moved as the odometry says

std::uint64_t digest_of(const FeatureMap& features) {
  Fnv1a64 hash;
  hash.add(fmt::format("{} {}", features.cells.cols(), features.cell_m));
  hash.add(characters_of(features.cells.cells()));
  return hash.value();
}

FeatureMap coarser(const FeatureMap& features) {
  const int across = std::max(features.cells.cols(), features.cells.rows());
  return resampled(features, features.cell_m * std::max(kCoarser, std::ceil(1.0 * across / kMaxAcrossCompared)));
}

/// But for what another height makes of the same frame.
bool has_same_shape(const FeatureMap& a, const FeatureMap& b) {
  constexpr double kAlike = 0.1;
  const auto alike = [](int cells, int others) { return std::abs(cells - others) <= kAlike * std::max(cells, others); };
  return a.cell_m == b.cell_m && alike(a.cells.cols(), b.cells.cols()) && alike(a.cells.rows(), b.cells.rows());
}

/// Pearson's over the cells observed in both, with `earlier` laid where it was taken; nullopt if there are too few.
std::optional<double> correlation_of(const FeatureMap& features, const PlacedFeatures& earlier) {
  const Placement placement = placement_in(earlier, features.nadir);
  MatchSums sums;
  for (int row = 0; row < features.cells.rows(); ++row) {
    for (int col = 0; col < features.cells.cols(); ++col) {
      const Cell now = features.cells.at(col, row);
      const Cell before = bilinear(earlier.features.cells, placement.source_of(col + 0.5, row + 0.5));
      if (is_observed(now) && is_observed(before)) sums.add(probability(before), probability(now));
    }
  }
  if (static_cast<double>(sums.n) < kMinShareInCommon * static_cast<double>(features.cells.observed_count())) {
    return std::nullopt;
  }
  return pearson(sums);
}

/// How far what lies halfway to the rim of a picture moves in it, as a share of its side.
double share_apart(const BodyOffset& offset, double side_m) {
  return distance_m(offset) / side_m + 0.25 * std::abs(offset.turn.radians());
}

/// The same of roads, in cells.
double cells_apart(const PlacedFeatures& earlier) {
  const int across = std::min(earlier.features.cells.cols(), earlier.features.cells.rows());
  return across * share_apart(earlier.offset, across * earlier.features.cell_m);
}

}  // namespace

void LastView::move(const std::optional<Odometry>& odometry, bool is_complete) {
  for (SeenView& view : seen) {
    view.moved_m += odometry ? distance_m(*odometry) : kMovedM;
    view.turned_rad += odometry ? std::abs(odometry->turn.radians()) : 0.0;
  }
  if (stands_still) return;
  if (!odometry) {
    earlier_picture.reset();  // it may hover
  } else if (earlier_picture) {
    earlier_picture->moved = offset_from({}, moved(moved({}, earlier_picture->moved), *odometry));
  }
  if (odometry && is_complete) {
    earlier.move(*odometry, {});
  } else {
    earlier.clear();
  }
}

/// Remembers it if it is new.
bool LastView::was_seen_before_it_moved(std::uint64_t digest) {
  const auto same = std::ranges::find(seen, digest, &SeenView::digest);
  if (same != seen.end()) return has_moved(same->moved_m, same->turned_rad);
  seen.insert(seen.begin(), {digest});
  if (seen.size() > kRemembered) seen.pop_back();
  return false;
}

View LastView::take_in(const FeatureMap& features, const std::optional<SentPicture>& picture) {
  if (picture && was_seen_before_it_moved(picture->digest)) return View::kRepeated;
  if (picture) {
    const View view = compared(picture->sketch, features.side_m());
    if (view != View::kNew) return view;
  }
  if (!has_road_cell(features)) {
    earlier.clear();
    stands_still = false;
    return View::kNew;
  }
  if (was_seen_before_it_moved(digest_of(features))) return View::kRepeated;
  stands_still = lies_as_earlier(coarser(features));
  return stands_still ? View::kStandsStill : View::kNew;
}

/// Keeps the picture to be compared with later ones, unless it is the same. `side_m`: of the ground that it shows.
View LastView::compared(const PictureSketch& sketch, double side_m) {
  if (!earlier_picture || !is_same_picture(earlier_picture->sketch, sketch)) {
    earlier_picture = {sketch};
    return View::kNew;
  }
  if (!stands_still && share_apart(earlier_picture->moved, side_m) < kApartShare) return View::kNew;
  stands_still = stands_still || earlier_picture->came_again;
  earlier_picture->came_again = true;
  return stands_still ? View::kStandsStill : View::kMayStandStill;
}

/// Keeps `features` to be compared with later views, unless they stand still or have hardly moved.
bool LastView::lies_as_earlier(const FeatureMap& features) {
  if (!earlier.frames().empty() && has_same_shape(earlier.frames().front().placed.features, features)) {
    const PlacedFeatures& placed = earlier.frames().front().placed;
    if (!stands_still && cells_apart(placed) < kApartCells) return false;
    const std::optional<double> still = correlation_of(features, {placed.features, {}});
    const std::optional<double> moved = correlation_of(features, placed);
    if (still >= kStillCorrelation && (stands_still || (moved && *still - *moved >= kStillMargin))) return true;
  }
  earlier.clear();
  earlier.keep(features);
  return false;
}

}  // namespace roadfix
