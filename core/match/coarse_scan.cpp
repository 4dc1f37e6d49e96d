#include "core/match/coarse_scan.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <memory>
#include <mutex>
#include <span>

#include "core/grid/feature_rotator.hpp"
#include "core/match/correlator.hpp"
#include "core/match/footprint.hpp"
#include "core/match/scan_kernel.hpp"
#include "core/match/scan_means.hpp"
#include "core/match/scan_planes.hpp"
#include "core/units/parallel_for.hpp"

namespace roadfix {
namespace {

/// Neighbouring headings that share the means and spreads under the footprint, which hardly change from one to the
/// next, and the two parts of a complex transform.
constexpr int kHeadingsTogether = 2;

int widened_for_vectors(int cols) { return cols + kRowOverrun; }

/// Planes that a thread uses again and again.
struct ScanBuffers {
  Spectrum cross;
  Correlator::Workspace workspace;
  ScanMeansWorkspace means_workspace;
  std::array<ScanMeans, 2> means;  ///< of the headings as they are, and turned by half a turn
  FloatPlane correction, gain, scores;
  std::vector<int> peaks;

  explicit ScanBuffers(const ScanMap& map)
      : cross(map.values().side()),
        workspace(map.values().side()),
        means_workspace(map),
        scores(widened_for_vectors(map.values().side()), map.values().side()) {}
};

/// What scans of some headings found.
struct Found {
  std::vector<ScanPose> maxima;
  double squares = 0.0;
  std::int64_t poses = 0;
  std::size_t headings = 0;
};

class Scan {
 public:
  Scan(const ScanMap& map, const FeatureMap& features, const ScanRequest& request, const Deadline& deadline)
      : rotator_(features),
        request_(request),
        deadline_(deadline),
        map_(map),
        reach_(map.reach()),
        lead_col_(request.positions.origin.col - map.geometry().origin.col),
        lead_row_(request.positions.origin.row - map.geometry().origin.row),
        full_cells_(static_cast<double>(features.cells.observed_count())),
        feature_mean_(mean_of(features.cells)),
        means_grid_(map, {request.positions.cols, request.positions.rows, lead_col_, lead_row_}),
        eligible_(widened_for_vectors(request.positions.cols + 2), request.positions.rows + 2) {
    assert(lead_col_ >= reach_ && lead_row_ >= reach_ && footprint_reach(features) <= reach_);
    for (int row = 0; row < request.positions.rows; ++row) {
      for (int col = 0; col < request.positions.cols; ++col) {
        eligible_.at(col + 1, row + 1) = request.eligible(col, row) ? 1.0F : 0.0F;
      }
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
    parallel_for((count + kHeadingsTogether - 1) / kHeadingsTogether, request_.threads, [&](int i) {
      const int first = i * kHeadingsTogether;
      scan_pair(std::span(bases).subspan(static_cast<std::size_t>(first),
                                         static_cast<std::size_t>(std::min(kHeadingsTogether, count - first))));
    });
    result_.share =
        static_cast<double>(scanned_) / static_cast<double>(std::max<std::size_t>(1, request_.headings.size()));
    std::ranges::sort(result_.maxima, std::ranges::greater{}, &ScanPose::score);
    if (result_.maxima.size() > request_.keep) result_.maxima.resize(request_.keep);
    return std::move(result_);
  }

 private:
  /// A pair of headings as they are, or both turned by half a turn; -1 for one that is not asked for.
  struct Direction {
    bool half_turn = false;
    std::array<int, kHeadingsTogether> bins{-1, -1};

    std::size_t count() const {
      return static_cast<std::size_t>(std::ranges::count_if(bins, [](int bin) { return bin >= 0; }));
    }
  };

  /// Those with a heading that is asked for.
  std::vector<Direction> directions_of(std::span<const int> bases) const {
    std::vector<Direction> directions;
    for (const bool half_turn : {false, true}) {
      Direction direction{half_turn};
      for (std::size_t i = 0; i < bases.size(); ++i) {
        const int bin = bases[i] + (half_turn ? request_.bins.count() / 2 : 0);
        if (std::ranges::binary_search(request_.headings, bin)) direction.bins[i] = bin;
      }
      if (direction.count() > 0) directions.push_back(direction);
    }
    return directions;
  }

  /// A pair of neighbouring headings, and the same turned by half a turn.
  void scan_pair(std::span<const int> bases) {
    if (deadline_.over()) return;
    std::unique_ptr<ScanBuffers> buffers = taken_buffers();
    const CellArray first = patch_at(bases.front());
    const ScanMeansPatch means(map_, means_grid_.block_means(first, feature_mean_), buffers->means_workspace);
    const std::vector<Direction> directions = directions_of(bases);
    Found found;
    for (const Direction& direction : directions) {
      means.at(direction.half_turn, full_cells_, std::max(1.0, request_.min_observed_share * full_cells_),
               buffers->means[direction.half_turn ? 1 : 0]);
      found.headings += direction.count();
    }
    map_.values().spectrum_of(values_of(first, feature_mean_),
                              bases.size() > 1 ? values_of(patch_at(bases.back()), feature_mean_) : FloatPlane(),
                              buffers->workspace, buffers->cross);
    const float floor = current_floor();
    for (std::size_t tile = 0; tile < map_.values().tiles(); ++tile) {
      if (deadline_.over()) return;
      for (const Direction& direction : directions) scan_tile(tile, direction, floor, *buffers, found);
    }
    add(std::move(found), std::move(buffers));
  }

  /// The footprint at a heading: a square of the full reach, so that its nadir is always the same cell.
  CellArray patch_at(int bin) const {
    const FeatureMap turned = rotator_.rotated(request_.bins.heading(bin));
    CellArray square(2 * reach_ + 1, 2 * reach_ + 1);
    paste(turned.cells, square, reach_ - static_cast<int>(turned.nadir.col),
          reach_ - static_cast<int>(turned.nadir.row));
    return square;
  }

  /// Positions of a tile: from -1 to cols or rows, so that every position of the request is within some tile's inner
  /// part.
  struct Range {
    int first = 0;
    int last = 0;  ///< behind the last one
    int count() const { return last - first; }
  };

  void scan_tile(std::size_t tile, const Direction& direction, float floor, ScanBuffers& buffers, Found& found) const {
    const Correlator::TileSums sums =
        map_.values().correlate_tile(tile, buffers.cross, direction.half_turn, buffers.workspace);
    // Nadir at map cell p: the patch's first cell lies reach before it, turned around reach after it.
    const int shift = (direction.half_turn ? reach_ : -reach_) + Correlator::kLead;
    const auto positions = [&](int place, int count, int lead, int size) {
      const int first = place - lead - shift;
      return Range{std::max(first, -1), std::min(first + count, size + 1)};
    };
    const Range cols = positions(sums.col, sums.cols, lead_col_, request_.positions.cols);
    const Range rows = positions(sums.row, sums.rows, lead_row_, request_.positions.rows);
    if (cols.count() < 3 || rows.count() < 3) return;
    widen_means(direction, cols, rows, buffers);
    const std::ptrdiff_t start =
        (rows.first + lead_row_ + shift - sums.row) * sums.stride + cols.first + lead_col_ + shift - sums.col;
    for (std::size_t i = 0; i < direction.bins.size(); ++i) {
      if (direction.bins[i] < 0) continue;
      const float* from = (i == 0 ? sums.first : sums.second) + start;
      const float scale = i == 0 ? sums.first_scale : sums.second_scale;
      score(direction, cols, rows, {from, sums.stride, scale}, buffers);
      collect(direction.bins[i], cols, rows, floor, buffers, found);
    }
  }

  /// The means at the columns of a tile, for the rows of blocks that its rows lie between.
  void widen_means(const Direction& direction, Range cols, Range rows, ScanBuffers& buffers) const {
    const BlockMixes& of_rows = means_grid_.rows(direction.half_turn);
    const Range blocks{of_rows.first[static_cast<std::size_t>(rows.first + 1)],
                       of_rows.second[static_cast<std::size_t>(rows.last)] + 1};
    const ScanMeans& means = buffers.means[direction.half_turn ? 1 : 0];
    const BlockMixes& mixes = means_grid_.cols(direction.half_turn);
    widen(means.correction, mixes, cols, blocks, buffers.correction);
    widen(means.gain, mixes, cols, blocks, buffers.gain);
  }

  static void widen(const FloatPlane& blocks, const BlockMixes& mixes, Range cols, Range rows, FloatPlane& out) {
    out.resize(widened_for_vectors(cols.count()), rows.count());
    const std::ptrdiff_t from = cols.first + 1;
    for (int row = 0; row < out.rows; ++row) {
      mix_blocks(blocks.row(rows.first + row), mixes.first.data() + from, mixes.second.data() + from,
                 mixes.share.data() + from, cols.count(), out.row(row));
    }
  }

  struct Cross {
    const float* sums;
    std::ptrdiff_t stride;
    float scale;
  };

  void score(const Direction& direction, Range cols, Range rows, const Cross& cross, ScanBuffers& buffers) const {
    const BlockMixes& of_rows = means_grid_.rows(direction.half_turn);
    const int first_block = of_rows.first[static_cast<std::size_t>(rows.first + 1)];
    for (int row = rows.first; row < rows.last; ++row) {
      const auto at = static_cast<std::size_t>(row + 1);
      const int above = of_rows.first[at] - first_block;
      const int below = of_rows.second[at] - first_block;
      ScoreRow scored;
      scored.sums = cross.sums + (row - rows.first) * cross.stride;
      scored.scale = cross.scale;
      scored.correction = {buffers.correction.row(above), buffers.correction.row(below)};
      scored.gain = {buffers.gain.row(above), buffers.gain.row(below)};
      scored.share = of_rows.share[at];
      scored.eligible = eligible_.row(row + 1) + cols.first + 1;
      score_row(scored, cols.count(), buffers.scores.row(row - rows.first));
    }
  }

  /// Local maxima among the eight neighbours, and the spread of all scores.
  static void collect(int bin, Range cols, Range rows, float floor, ScanBuffers& buffers, Found& found) {
    for (int row = 1; row + 1 < rows.count(); ++row) {
      const float* scores = buffers.scores.row(row);
      buffers.peaks.clear();
      const RowTotals totals = summarize_row(buffers.scores.row(row - 1), scores, buffers.scores.row(row + 1), 1,
                                             cols.count() - 1, floor, buffers.peaks);
      found.squares += totals.squares;
      found.poses += totals.poses;
      for (const int col : buffers.peaks) {
        found.maxima.push_back({cols.first + col, rows.first + row, bin, scores[col]});
      }
    }
  }

  void add(Found found, std::unique_ptr<ScanBuffers> buffers) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(buffers));
    result_.score_square_sum += found.squares;
    result_.poses += found.poses;
    scanned_ += found.headings;
    result_.maxima.insert(result_.maxima.end(), found.maxima.begin(), found.maxima.end());
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

  std::unique_ptr<ScanBuffers> taken_buffers() {
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) return std::make_unique<ScanBuffers>(map_);
    std::unique_ptr<ScanBuffers> buffers = std::move(idle_.back());
    idle_.pop_back();
    return buffers;
  }

  FeatureRotator rotator_;
  const ScanRequest& request_;
  const Deadline& deadline_;
  const ScanMap& map_;
  int reach_;
  int lead_col_;  ///< of the positions within the map
  int lead_row_;
  double full_cells_;
  double feature_mean_;
  ScanMeansGrid means_grid_;
  FloatPlane eligible_;  ///< 1 or 0; from position (-1, -1) on
  std::mutex mutex_;
  std::vector<std::unique_ptr<ScanBuffers>> idle_;
  float floor_ = 0.0F;
  std::size_t scanned_ = 0;  ///< headings
  ScanResult result_;
};

}  // namespace

ScanResult coarse_scan(const ScanMap& map, const FeatureMap& features, const ScanRequest& request,
                       const Deadline& deadline) {
  return Scan(map, features, request, deadline).run();
}

}  // namespace roadfix
