#include "core/match/coarse_scan.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <mutex>
#include <span>

#include "core/grid/resample.hpp"
#include "core/match/correlator.hpp"
#include "core/match/scan_planes.hpp"
#include "core/match/score.hpp"

namespace roadfix {
namespace {

class Scan {
 public:
  Scan(const ScanMap& map, const FeatureMap& features, const ScanRequest& request, const Deadline& deadline)
      : features_(features),
        request_(request),
        deadline_(deadline),
        map_(map),
        reach_(map.reach()),
        q_(map.block()),
        lead_col_(request.positions.origin.col - map.geometry().origin.col),
        lead_row_(request.positions.origin.row - map.geometry().origin.row),
        full_cells_(static_cast<double>(features.cells.observed_count())),
        feature_mean_(mean_of(features.cells)),
        eligible_(request.positions.cols, request.positions.rows) {
    assert(lead_col_ >= reach_ && lead_row_ >= reach_ && footprint_reach(features) <= reach_);
    for (int row = 0; row < eligible_.rows; ++row) {
      for (int col = 0; col < eligible_.cols; ++col) eligible_.at(col, row) = request.eligible(col, row) ? 1.0F : 0.0F;
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
    const ScanPlanes first = patch_at(bases.front());
    const ScanPlanes last = bases.size() > 1 ? patch_at(bases.back()) : ScanPlanes{};
    const ComplexPlane cross = map_.values().spectrum_of(first.value, last.value);
    const MeanSpectra means = means_of(first);
    for (const bool half_turn : {false, true}) {
      const int turn = half_turn ? request_.bins.count() / 2 : 0;
      const auto wanted = [&](int base) { return std::ranges::binary_search(request_.headings, base + turn); };
      if (std::ranges::none_of(bases, wanted)) continue;
      if (deadline_.over()) return;
      const Blocks blocks = blocks_of(means, half_turn);
      const FloatPlanes sums = map_.values().correlate(cross, half_turn);
      if (wanted(bases.front())) collect(scores(sums.first, blocks, half_turn), bases.front() + turn);
      if (bases.size() > 1 && wanted(bases.back())) {
        collect(scores(sums.second, blocks, half_turn), bases.back() + turn);
      }
    }
  }

  /// Planes of the footprint at a heading: a square of the full reach, so that its nadir is always the same cell.
  ScanPlanes patch_at(int bin) const {
    const FeatureMap turned = rotated(features_, request_.bins.heading(bin));
    CellArray square(2 * reach_ + 1, 2 * reach_ + 1);
    paste(turned.cells, square, reach_ - static_cast<int>(turned.nadir.col),
          reach_ - static_cast<int>(turned.nadir.row));
    return planes_of(square, feature_mean_);
  }

  struct MeanSpectra {
    ComplexPlane observed_and_value, square, observed;
  };

  MeanSpectra means_of(const ScanPlanes& planes) const {
    const auto means = [&](const FloatPlane& plane) {
      FloatPlane sums = block_sums(plane, q_, block_lead());
      for (float& sum : sums.values) sum /= static_cast<float>(q_ * q_);
      return sums;
    };
    const FloatPlane observed = means(planes.observed);
    return {map_.block_observed().spectrum_of(observed, means(planes.value)),
            map_.block_observed().spectrum_of(means(planes.square), {}), map_.block_values().spectrum_of(observed, {})};
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
    const auto [n, l] = map_.block_observed().correlate(patch.observed_and_value, half_turn);
    const FloatPlane ll = map_.block_observed().correlate(patch.square, half_turn).first;
    const auto [m, mm] = map_.block_values().correlate(patch.observed, half_turn);
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
    const int offset = Correlator::kLead - blocks.first;
    const std::vector<BlockMix> rows = mixes(positions.rows, lead_row_ - centre, q_, offset, blocks.gain.rows);
    const std::vector<BlockMix> cols = mixes(positions.cols, lead_col_ - centre, q_, offset, blocks.gain.cols);
    const FloatPlane correction = widened(blocks.correction, cols);
    const FloatPlane gain = widened(blocks.gain, cols);
    for (int row = 0; row < positions.rows; ++row) {
      const BlockMix down = rows[static_cast<std::size_t>(row)];
      const float *correction0 = correction.row(down.first), *correction1 = correction.row(down.second);
      const float *gain0 = gain.row(down.first), *gain1 = gain.row(down.second);
      const float* sums =
          cross.row(row + lead_row_ + shift + Correlator::kLead) + lead_col_ + shift + Correlator::kLead;
      const float* eligible = eligible_.row(row);
      float* out = result.row(row);
      for (int col = 0; col < positions.cols; ++col) {
        out[col] =
            eligible[col] * (sums[col] - down.of(correction0[col], correction1[col])) * down.of(gain0[col], gain1[col]);
      }
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
      const std::span<const float> line(scores.row(row), static_cast<std::size_t>(scores.cols));
      squares += square_sum(line);
      poses += std::ssize(line) - std::ranges::count(line, 0.0F);  // not eligible, or not enough observed
      for (int col = 0; col < scores.cols; ++col) {
        const float score = line[static_cast<std::size_t>(col)];
        if (score > floor && is_peak(scores, col, row)) found.push_back({col, row, bin, score});
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

  float current_floor() {
    const std::lock_guard lock(mutex_);
    return floor_;
  }

  const FeatureMap& features_;
  const ScanRequest& request_;
  const Deadline& deadline_;
  const ScanMap& map_;
  int reach_;
  int q_;         ///< cells per block, an edge
  int lead_col_;  ///< of the positions within the map
  int lead_row_;
  double full_cells_;
  double feature_mean_;
  FloatPlane eligible_;  ///< 1 or 0
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

ScanResult coarse_scan(const ScanMap& map, const FeatureMap& features, const ScanRequest& request,
                       const Deadline& deadline) {
  return Scan(map, features, request, deadline).run();
}

}  // namespace roadfix
