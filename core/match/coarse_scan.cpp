#include "core/match/coarse_scan.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <mutex>
#include <optional>
#include <span>

#include "core/grid/resample.hpp"
#include "core/match/correlator.hpp"
#include "core/match/score.hpp"

namespace roadfix {
namespace {

/// Observed cells as three planes: 1 where observed, the value less `mean`, and its square.
struct Planes {
  FloatPlane observed, value, square;
};

double mean_of(const CellArray& cells) {
  double sum = 0.0;
  std::int64_t count = 0;
  for (const Cell cell : cells.cells()) {
    if (!is_observed(cell)) continue;
    sum += probability(cell);
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

Planes planes_of(const CellArray& cells, double mean) {
  const FloatPlane empty(cells.cols(), cells.rows());
  Planes planes{empty, empty, empty};
  for (int row = 0; row < cells.rows(); ++row) {
    for (int col = 0; col < cells.cols(); ++col) {
      const Cell cell = cells.at(col, row);
      if (!is_observed(cell)) continue;
      const auto value = static_cast<float>(probability(cell) - mean);
      planes.observed.at(col, row) = 1.0F;
      planes.value.at(col, row) = value;
      planes.square.at(col, row) = value * value;
    }
  }
  return planes;
}

/// Sum over blocks of q x q cells, the first block starting `lead` cells before the first cell.
FloatPlane block_sums(const FloatPlane& plane, int q, int lead) {
  const auto blocks = [&](int cells) { return (cells + lead + q - 1) / q; };
  FloatPlane sums(blocks(plane.cols), blocks(plane.rows));
  for (int row = 0; row < plane.rows; ++row) {
    for (int col = 0; col < plane.cols; ++col) sums.at((col + lead) / q, (row + lead) / q) += plane.at(col, row);
  }
  return sums;
}

int floor_div(int a, int b) { return a >= 0 ? a / b : -((-a + b - 1) / b); }

class Scan {
 public:
  Scan(const RoadGrid& map, const FeatureMap& features, const ScanRequest& request, const Deadline& deadline)
      : features_(features),
        request_(request),
        deadline_(deadline),
        reach_(footprint_reach(features)),
        lead_col_(request.positions.origin.col - map.geometry.origin.col),
        lead_row_(request.positions.origin.row - map.geometry.origin.row),
        full_cells_(static_cast<double>(features.cells.observed_count())),
        feature_mean_(mean_of(features.cells)),
        q_(std::clamp(std::min(features.cells.cols(), features.cells.rows()) / 12, 1, 4)) {
    assert(lead_col_ >= reach_ && lead_row_ >= reach_);
    const Planes planes = planes_of(map.cells, mean_of(map.cells));
    cross_.emplace(planes.value, FloatPlane(), 2 * reach_ + 1);
    const int block_patch = (2 * reach_ + 1 + q_ - 1) / q_ + 1;
    observed_.emplace(block_sums(planes.observed, q_, 0), FloatPlane(), block_patch);
    values_.emplace(block_sums(planes.value, q_, 0), block_sums(planes.square, q_, 0), block_patch);
    eligible_.reserve(static_cast<std::size_t>(request.positions.cols) *
                      static_cast<std::size_t>(request.positions.rows));
    for (int row = 0; row < request.positions.rows; ++row) {
      for (int col = 0; col < request.positions.cols; ++col) eligible_.push_back(request.eligible(col, row));
    }
  }

  ScanResult run() {
    // A footprint turned by half a turn has the conjugate spectrum: bins b and b + half share their transforms.
    const int half = request_.bins.count() / 2;
    std::vector<int> bases;
    for (const int bin : request_.headings) bases.push_back(bin % half);
    std::ranges::sort(bases);
    bases.erase(std::unique(bases.begin(), bases.end()), bases.end());
    const int count = static_cast<int>(bases.size());
    parallel_for((count + kSharing - 1) / kSharing, request_.threads, [&](int i) {
      const int first = i * kSharing;
      scan_pairs(std::span(bases).subspan(static_cast<std::size_t>(first),
                                          static_cast<std::size_t>(std::min(kSharing, count - first))));
    });
    result_.share =
        static_cast<double>(scanned_) / static_cast<double>(std::max<std::size_t>(1, request_.headings.size()));
    std::ranges::sort(result_.maxima, std::ranges::greater{}, &ScanPose::score);
    if (result_.maxima.size() > request_.keep) result_.maxima.resize(request_.keep);
    return std::move(result_);
  }

 private:
  /// What the means and spreads under a footprint are hardly changes from one heading to the next: these share them,
  /// and a transform.
  static constexpr int kSharing = 2;

  void scan_pairs(std::span<const int> bases) {
    if (deadline_.over()) return;
    const Planes first = patch_at(bases.front());
    const Planes last = bases.size() > 1 ? patch_at(bases.back()) : Planes{};
    const ComplexPlane cross = cross_->spectrum_of(first.value, last.value);
    const MeanSpectra means = means_of(first);
    for (const bool half_turn : {false, true}) {
      const int turn = half_turn ? request_.bins.count() / 2 : 0;
      const auto wanted = [&](int base) { return std::ranges::binary_search(request_.headings, base + turn); };
      if (std::ranges::none_of(bases, wanted)) continue;
      if (deadline_.over()) return;
      const Blocks blocks = blocks_of(means, half_turn);
      const FloatPlanes sums = cross_->correlate(cross, half_turn);
      if (wanted(bases.front())) collect(scores(sums.first, blocks, half_turn), bases.front() + turn);
      if (bases.size() > 1 && wanted(bases.back())) {
        collect(scores(sums.second, blocks, half_turn), bases.back() + turn);
      }
    }
  }

  /// Planes of the footprint at a heading: a square of the full reach, so that its nadir is always the same cell.
  Planes patch_at(int bin) const {
    const FeatureMap turned = rotated(features_, request_.bins.heading(bin));
    CellArray square(2 * reach_ + 1, 2 * reach_ + 1);
    paste(turned.cells, square, reach_ - static_cast<int>(turned.nadir.col),
          reach_ - static_cast<int>(turned.nadir.row));
    return planes_of(square, feature_mean_);
  }

  struct MeanSpectra {
    ComplexPlane observed_and_value, square, observed;
  };

  MeanSpectra means_of(const Planes& planes) const {
    const auto means = [&](const FloatPlane& plane) {
      FloatPlane sums = block_sums(plane, q_, block_lead());
      for (float& sum : sums.values) sum /= static_cast<float>(q_ * q_);
      return sums;
    };
    const FloatPlane observed = means(planes.observed);
    return {observed_->spectrum_of(observed, means(planes.value)), observed_->spectrum_of(means(planes.square), {}),
            values_->spectrum_of(observed, {})};
  }

  /// Puts the nadir into the middle of its block (at (q - 1) / 2, rounded down).
  int block_lead() const { return ((half_block() - reach_) % q_ + q_) % q_; }
  int half_block() const { return (q_ - 1) / 2; }
  int nadir_block() const { return (reach_ + block_lead()) / q_; }

  /// Score = (cross - correction) * gain; both vary slowly and are known per block of positions.
  struct Blocks {
    FloatPlane correction, gain;
    int first = 0;  ///< block whose result lies in the first row and column
  };

  Blocks blocks_of(const MeanSpectra& patch, bool half_turn) const {
    const auto [n, l] = observed_->correlate(patch.observed_and_value, half_turn);
    const FloatPlane ll = observed_->correlate(patch.square, half_turn).first;
    const auto [m, mm] = values_->correlate(patch.observed, half_turn);
    Blocks blocks{FloatPlane(n.cols, n.rows), FloatPlane(n.cols, n.rows), half_turn ? -nadir_block() : nadir_block()};
    const double least = std::max(1.0, request_.min_observed_share * full_cells_);
    for (int row = 0; row < n.rows; ++row) {
      for (int col = 0; col < n.cols; ++col) {
        const auto cells = static_cast<double>(n.at(col, row));
        if (cells < least) continue;
        const auto m_sum = static_cast<double>(m.at(col, row));
        const auto l_sum = static_cast<double>(l.at(col, row));
        const double map_spread = static_cast<double>(mm.at(col, row)) - m_sum * m_sum / cells;
        const double feature_spread = static_cast<double>(ll.at(col, row)) - l_sum * l_sum / cells;
        if (map_spread < kLeastSpread * cells || feature_spread < kLeastSpread * cells) continue;
        blocks.correction.at(col, row) = static_cast<float>(m_sum * l_sum / cells);
        blocks.gain.at(col, row) = static_cast<float>(std::sqrt(cells / full_cells_ / (map_spread * feature_spread)));
      }
    }
    return blocks;
  }

  FloatPlane scores(const FloatPlane& cross, const Blocks& blocks, bool half_turn) const {
    const GridGeometry& positions = request_.positions;
    FloatPlane result(positions.cols, positions.rows);
    // Nadir at map cell p: the patch's first cell lies reach before it, turned around reach after it.
    const int shift = half_turn ? reach_ : -reach_;
    // A block result with its nadir block at B stands for the nadir at B * q + half_block, turned around at
    // B * q + q - 1 - half_block.
    const int centre = half_turn ? q_ - 1 - half_block() : half_block();
    const std::vector<Mix> rows = mixes(positions.rows, lead_row_ - centre, blocks.first, blocks.gain.rows);
    const std::vector<Mix> cols = mixes(positions.cols, lead_col_ - centre, blocks.first, blocks.gain.cols);
    std::vector<float> correction(static_cast<std::size_t>(blocks.gain.cols));
    std::vector<float> gain(correction.size());
    for (int row = 0; row < positions.rows; ++row) {
      const Mix down = rows[static_cast<std::size_t>(row)];
      for (std::size_t i = 0; i < gain.size(); ++i) {
        const int col = static_cast<int>(i);
        correction[i] = down.of(blocks.correction.at(col, down.first), blocks.correction.at(col, down.second));
        gain[i] = down.of(blocks.gain.at(col, down.first), blocks.gain.at(col, down.second));
      }
      const float* sums =
          cross.row(row + lead_row_ + shift + Correlator::kLead) + lead_col_ + shift + Correlator::kLead;
      for (int col = 0; col < positions.cols; ++col) {
        if (!eligible_[index(col, row)]) continue;
        const Mix right = cols[static_cast<std::size_t>(col)];
        const auto left = static_cast<std::size_t>(right.first);
        const auto next = static_cast<std::size_t>(right.second);
        result.at(col, row) =
            (sums[col] - right.of(correction[left], correction[next])) * right.of(gain[left], gain[next]);
      }
    }
    return result;
  }

  /// Linear interpolation between two blocks.
  struct Mix {
    int first = 0;
    int second = 0;
    float share = 0.0F;  ///< of the second
    float of(float a, float b) const { return a + share * (b - a); }
  };

  /// For cells start, start + 1, ...: between which blocks they lie.
  std::vector<Mix> mixes(int count, int start, int first_block, int blocks) const {
    std::vector<Mix> result;
    for (int cell = start; cell < start + count; ++cell) {
      const int block = floor_div(cell, q_);
      const auto place = [&](int i) { return std::clamp(i - first_block + Correlator::kLead, 0, blocks - 1); };
      result.push_back(
          {place(block), place(block + 1), static_cast<float>(cell - block * q_) / static_cast<float>(q_)});
    }
    return result;
  }

  /// Local maxima among the eight neighbours, and the spread of all scores.
  void collect(const FloatPlane& scores, int bin) {
    std::vector<ScanPose> found;
    double squares = 0.0;
    std::int64_t poses = 0;
    const float floor = current_floor();
    for (int row = 0; row < scores.rows; ++row) {
      for (int col = 0; col < scores.cols; ++col) {
        const float score = scores.at(col, row);
        if (score == 0.0F) continue;  // not eligible, or not enough observed
        squares += static_cast<double>(score) * static_cast<double>(score);
        ++poses;
        if (score > floor && is_peak(scores, row, col)) found.push_back({col, row, bin, score});
      }
    }
    const std::lock_guard lock(mutex_);
    result_.score_square_sum += squares;
    result_.poses += poses;
    ++scanned_;
    result_.maxima.insert(result_.maxima.end(), found.begin(), found.end());
    if (result_.maxima.size() < 4 * request_.keep) return;
    const auto cut = result_.maxima.begin() + static_cast<std::ptrdiff_t>(request_.keep);
    std::ranges::nth_element(result_.maxima, cut, std::ranges::greater{}, &ScanPose::score);
    floor_ = cut->score;
    result_.maxima.erase(cut, result_.maxima.end());
  }

  std::size_t index(int col, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(request_.positions.cols) +
           static_cast<std::size_t>(col);
  }

  static bool is_peak(const FloatPlane& scores, int row, int col) {
    for (int r = std::max(0, row - 1); r <= std::min(scores.rows - 1, row + 1); ++r) {
      for (int c = std::max(0, col - 1); c <= std::min(scores.cols - 1, col + 1); ++c) {
        if (scores.at(c, r) > scores.at(col, row)) return false;
      }
    }
    return true;
  }

  float current_floor() {
    const std::lock_guard lock(mutex_);
    return floor_;
  }

  const FeatureMap& features_;
  const ScanRequest& request_;
  const Deadline& deadline_;
  int reach_;
  int lead_col_;  ///< of the positions within the map
  int lead_row_;
  double full_cells_;
  double feature_mean_;
  int q_;                                                ///< cells per block, an edge
  std::optional<Correlator> cross_, observed_, values_;  ///< values_: the map's values, and their squares
  std::vector<bool> eligible_;
  std::mutex mutex_;
  float floor_ = 0.0F;
  std::size_t scanned_ = 0;  ///< headings
  ScanResult result_;
};

}  // namespace

int footprint_reach(const FeatureMap& features) {
  double reach = 0.0;
  for (const double col : {0.0, static_cast<double>(features.cells.cols())}) {
    for (const double row : {0.0, static_cast<double>(features.cells.rows())}) {
      reach = std::max(reach, std::hypot(col - features.nadir.col, row - features.nadir.row));
    }
  }
  return static_cast<int>(std::ceil(reach)) + 1;
}

ScanResult coarse_scan(const RoadGrid& map, const FeatureMap& features, const ScanRequest& request,
                       const Deadline& deadline) {
  return Scan(map, features, request, deadline).run();
}

}  // namespace roadfix
