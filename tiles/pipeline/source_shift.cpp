#include "tiles/pipeline/source_shift.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <opencv2/imgproc.hpp>

#include "core/grid/cell.hpp"
#include "core/units/error.hpp"
#include "tiles/pipeline/witnesses.hpp"

namespace roadfix {
namespace {

constexpr int kStep = 2;       // cells
constexpr int kMaxShift = 25;  // steps
constexpr int kShifts = 2 * kMaxShift + 1;
constexpr int kSide = kTileCells / kStep;

/// A tile in squares of kStep cells: their observed share, the mean of their probabilities with unobserved cells as 0,
/// and the square of the mean over the observed cells, times the observed share.
struct Planes {
  cv::Mat1f seen;
  cv::Mat1f road;
  cv::Mat1f road2;

  explicit Planes(const CellArray& cells) {
    cv::Mat1f observed(cells.rows(), cells.cols());
    cv::Mat1f probable(cells.rows(), cells.cols());
    for (int row = 0; row < cells.rows(); ++row) {
      for (int col = 0; col < cells.cols(); ++col) {
        const Cell cell = cells.at(col, row);
        observed(row, col) = is_observed(cell) ? 1.0F : 0.0F;
        probable(row, col) = is_observed(cell) ? static_cast<float>(probability(cell)) : 0.0F;
      }
    }
    cv::resize(observed, seen, {kSide, kSide}, 0.0, 0.0, cv::INTER_AREA);
    cv::resize(probable, road, {kSide, kSide}, 0.0, 0.0, cv::INTER_AREA);
    constexpr double kOneCell = 1.0 / (kStep * kStep);
    cv::divide(road.mul(road), cv::max(seen, kOneCell), road2);
  }
};

/// The sums of a correlation for every shift of the source: rows to the south, columns to the east.
class ShiftSums {
 public:
  void add(const SharedEvidence::Tile& tile) {
    const Planes own(tile.own);
    const Planes others(tile.others);
    const auto sum = [](const cv::Mat1f& a, const cv::Mat1f& b, cv::Mat1d& into) {
      cv::Mat1f wide;  // nothing is known of the others beyond the tile
      cv::copyMakeBorder(b, wide, kMaxShift, kMaxShift, kMaxShift, kMaxShift, cv::BORDER_CONSTANT, 0.0);
      cv::Mat1f products;
      cv::matchTemplate(wide, a, products, cv::TM_CCORR);
      cv::accumulate(products, into);
    };
    sum(own.seen, others.seen, n_);
    sum(own.road, others.seen, a_);
    sum(own.seen, others.road, b_);
    sum(own.road2, others.seen, aa_);
    sum(own.seen, others.road2, bb_);
    sum(own.road, others.road, ab_);
  }

  /// Squares that both observed.
  double squares(int row, int col) const { return n_(row, col); }

  /// Pearson's; 0 where either side has no roads.
  double correlation(int row, int col) const {
    const double n = n_(row, col);
    const double mean_a = a_(row, col) / n;
    const double mean_b = b_(row, col) / n;
    const double variances = (aa_(row, col) / n - mean_a * mean_a) * (bb_(row, col) / n - mean_b * mean_b);
    constexpr double kNone = 1e-8;
    return variances > kNone ? (ab_(row, col) / n - mean_a * mean_b) / std::sqrt(variances) : 0.0;
  }

 private:
  cv::Mat1d n_ = cv::Mat1d(kShifts, kShifts, 0.0);
  cv::Mat1d a_ = n_.clone();
  cv::Mat1d b_ = n_.clone();
  cv::Mat1d aa_ = n_.clone();
  cv::Mat1d bb_ = n_.clone();
  cv::Mat1d ab_ = n_.clone();
};

/// A shift in steps.
struct Place {
  int east = 0;
  int north = 0;
};

struct Best {
  Place at;
  double correlation = -1.0;
};

/// The best of all shifts farther than `steps` from a place; a correlation of -1 if there is none.
Best best_beyond(const ShiftSums& sums, const Place& place, double steps) {
  constexpr double kMinShare = 0.5;  // of the squares in place: a narrow overlap fits somewhere by chance
  const double least = kMinShare * sums.squares(kMaxShift, kMaxShift);
  Best best;
  for (int row = 0; row < kShifts; ++row) {
    for (int col = 0; col < kShifts; ++col) {
      const Place here{col - kMaxShift, kMaxShift - row};
      if (sums.squares(row, col) < least || std::hypot(here.east - place.east, here.north - place.north) <= steps) {
        continue;
      }
      const double correlation = sums.correlation(row, col);
      if (correlation > best.correlation) best = {here, correlation};
    }
  }
  return best;
}

}  // namespace

std::optional<SourceShift> shift_of(const SharedEvidence& shared_evidence, double cell_m) {
  constexpr double kMinCorrelation = 0.15;
  constexpr double kMinGain = 1.3;  // over the correlation in place
  constexpr double kMinLead = 1.5;  // over all shifts kApartM away: chance, a lone road and regular streets have none
  constexpr double kApartM = 12.0;
  constexpr double kMinSteps = 1.5;
  constexpr double kSigmas = 2.0;
  constexpr double kMinSquares = 4000.0;
  constexpr double kMinGroundM2 = 0.25e6;  // on 0.1 km^2 two of three unrelated pairs fit somewhere
  const double step_m = kStep * cell_m;
  ShiftSums sums;
  for (const SharedEvidence::Tile& tile : shared_evidence.tiles) sums.add(tile);
  const double squares = sums.squares(kMaxShift, kMaxShift);
  if (squares < std::max(kMinSquares, kMinGroundM2 / (step_m * step_m))) return std::nullopt;

  const Best best = best_beyond(sums, {}, -1.0);
  const double rival = best_beyond(sums, best.at, std::max(3.0, kApartM / step_m)).correlation;
  SourceShift shift{.east_m = step_m * best.at.east,
                    .north_m = step_m * best.at.north,
                    .correlation = best.correlation,
                    .correlation_in_place = sums.correlation(kMaxShift, kMaxShift)};
  const double length_m = std::hypot(shift.east_m, shift.north_m);
  shift.sigma_m = 0.5 * length_m;
  const double explained_m =
      std::max(kMinSteps * step_m, kSigmas * std::hypot(shared_evidence.own_sigma_m, shared_evidence.others_sigma_m));
  const bool at_rim = std::max(std::abs(best.at.east), std::abs(best.at.north)) == kMaxShift;
  const bool sure = best.correlation >= kMinCorrelation && best.correlation >= kMinLead * rival;
  const bool elsewhere = !at_rim && length_m > explained_m && best.correlation >= kMinGain * shift.correlation_in_place;
  return sure && elsewhere ? std::optional(shift) : std::nullopt;
}

ShiftReport measure_shifts(MapWriter& writer, const std::set<std::string>& sources, const OnProgress& progress,
                           const std::stop_token& stop) {
  const std::int64_t total = std::ssize(sources);
  std::int64_t done = 0;
  const auto tell = [&] {
    if (progress && total > 1) progress(done, total);
  };
  std::map<std::string, std::optional<SourceShift>> measured;
  std::map<std::string, std::vector<std::string>> not_measured;  // by what is in the way
  ShiftReport result;
  Witnesses witnesses(writer);
  tell();
  for (const std::string& source : sources) {
    if (stop.stop_requested()) {
      throw Interrupted("work-stopped", fmt::format("stopped with {} of {} sources compared with the others. Repeat "
                                                    "the command to go on",
                                                    done, total));
    }
    try {
      const auto [copies, others] = witnesses.around(source);
      const SharedEvidence shared = writer.shared_evidence(source, others, kTilesCompared);
      const auto shift = shift_of(shared, writer.settings().cell_m);
      measured.emplace(source, shift);
      if (shift) result.shifted.insert({source, {*shift, shared.own_sigma_m}});
      if (!copies.empty()) result.copies.emplace(source, copies);
    } catch (const CorruptData& damage) {
      not_measured[damage.what()].push_back(source);
    }
    ++done;
    tell();
  }
  writer.put_shifts(measured);
  for (const auto& [damage, names] : not_measured) {
    result.notes.push_back(fmt::format("whether '{}' lies beside the other sources was not measured: {}",
                                       fmt::join(names, "' or '"), damage));
  }
  return result;
}

}  // namespace roadfix
