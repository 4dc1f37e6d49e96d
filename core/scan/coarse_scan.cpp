#include "core/scan/coarse_scan.hpp"

#include <algorithm>
#include <cassert>
#include <limits>
#include <memory>
#include <mutex>
#include <numeric>
#include <span>
#include <tuple>

#include "core/grid/cell_moments.hpp"
#include "core/grid/feature_rotator.hpp"
#include "core/match/footprint.hpp"
#include "core/match/score.hpp"
#include "core/scan/scan_planes.hpp"
#include "core/scan/scan_tile.hpp"
#include "core/units/parallel_for.hpp"

namespace roadfix {
namespace {

/// Neighbours, which share means; one whose neighbour is not among them, as at the end of a range, is alone.
std::vector<std::span<const int>> pairs_of(std::span<const int> bins) {
  std::vector<std::span<const int>> pairs;
  while (!bins.empty()) {
    const bool together = bins.size() > 1 && bins[1] == bins[0] + 1;
    pairs.push_back(bins.first(together ? 2 : 1));
    bins = bins.subspan(pairs.back().size());
  }
  return pairs;
}

/// A total order, so that what is kept does not depend on the order of threads.
bool is_better(const ScanPose& a, const ScanPose& b) {
  return std::tie(b.score, a.bin, a.row, a.col) < std::tie(a.score, b.bin, b.row, b.col);
}

class Scan {
 public:
  Scan(const ScanMap& map, const FeatureMap& features, const ScanRequest& request, const Deadline& deadline)
      : rotator_(features),
        request_(request),
        deadline_(deadline),
        map_(map),
        cells_(footprint_cells(features)),
        feature_mean_(moments_of(features.cells).mean()),
        tile_scan_(map, request) {
    assert(footprint_reach(features) <= map.reach());
  }

  ScanResult run() {
    // A footprint turned by half a turn has the conjugate spectrum: bins b and b + half share their transforms.
    const int half = request_.bins.count() / 2;
    std::vector<int> bases;
    for (const int bin : request_.headings) bases.push_back(bin % half);
    std::ranges::sort(bases);
    bases.erase(std::unique(bases.begin(), bases.end()), bases.end());
    const std::vector<std::span<const int>> pairs = pairs_of(bases);
    squares_.assign(pairs.size(), 0.0);
    parallel_for(static_cast<int>(pairs.size()), request_.threads,
                 [&](int i) { scan_pair(pairs[static_cast<std::size_t>(i)], squares_[static_cast<std::size_t>(i)]); });
    result_.score_square_sum = std::accumulate(squares_.begin(), squares_.end(), 0.0);
    result_.share =
        static_cast<double>(scanned_) / static_cast<double>(std::max<std::size_t>(1, request_.headings.size()));
    std::ranges::sort(result_.maxima, is_better);
    if (result_.maxima.size() > request_.keep) result_.maxima.resize(request_.keep);
    return std::move(result_);
  }

 private:
  /// Those of the two directions of a pair that have a heading asked for.
  std::vector<ScanDirection> directions_of(std::span<const int> bases) const {
    std::vector<ScanDirection> directions;
    for (const bool half_turn : {false, true}) {
      ScanDirection direction{half_turn};
      for (std::size_t i = 0; i < bases.size(); ++i) {
        const int bin = bases[i] + (half_turn ? request_.bins.count() / 2 : 0);
        if (std::ranges::binary_search(request_.headings, bin)) direction.bins[i] = bin;
      }
      if (direction.count() > 0) directions.push_back(direction);
    }
    return directions;
  }

  /// Scans a pair of neighbouring headings, and the same turned by half a turn. Sets the sum of their squared scores.
  void scan_pair(std::span<const int> bases, double& squares) {
    if (deadline_.over()) return;
    std::unique_ptr<ScanBuffers> buffers = taken_buffers();
    const CellArray first = patch_at(bases.front());
    const ScanMeansPatch means(map_, tile_scan_.alignment().block_means(first, feature_mean_),
                               buffers->means_workspace);
    const std::vector<ScanDirection> directions = directions_of(bases);
    ScanFindings found;
    for (const ScanDirection& direction : directions) {
      means.at(direction.half_turn, cells_, buffers->means[direction.half_turn ? 1 : 0]);
      found.headings += direction.count();
    }
    if (deadline_.over()) return;
    map_.values().spectrum_of(values_of(first, feature_mean_),
                              bases.size() > 1 ? values_of(patch_at(bases.back()), feature_mean_) : FloatPlane(),
                              buffers->workspace, buffers->cross);
    const float floor = current_floor();
    for (std::size_t tile = 0; tile < map_.values().tiles(); ++tile) {
      if (deadline_.over()) return;
      for (const ScanDirection& direction : directions) tile_scan_.scan(tile, direction, floor, *buffers, found);
    }
    squares = found.squares;
    add(std::move(found), std::move(buffers));
  }

  /// The footprint at a heading: a square of the full reach, so that its nadir is always the same cell.
  CellArray patch_at(int bin) const {
    const FeatureMap turned = rotator_.rotated(request_.bins.heading(bin));
    const int reach = map_.reach();
    CellArray square(2 * reach + 1, 2 * reach + 1);
    paste(turned.cells, square, reach - static_cast<int>(turned.nadir.col), reach - static_cast<int>(turned.nadir.row));
    return square;
  }

  void add(ScanFindings found, std::unique_ptr<ScanBuffers> buffers) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(buffers));
    result_.poses += found.poses;
    scanned_ += found.headings;
    if (request_.scanned) request_.scanned(scanned_);
    result_.maxima.insert(result_.maxima.end(), found.maxima.begin(), found.maxima.end());
    if (result_.maxima.size() < 4 * request_.keep) return;
    const auto cut = result_.maxima.begin() + static_cast<std::ptrdiff_t>(request_.keep);
    std::ranges::nth_element(result_.maxima, cut, is_better);
    floor_ = std::nextafter(cut->score, -std::numeric_limits<float>::infinity());  // its equals may be better
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
  FootprintCells cells_;
  double feature_mean_;
  TileScan tile_scan_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<ScanBuffers>> idle_;
  std::vector<double> squares_;  ///< of each pair, so that they are summed in the order of pairs, not of threads
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
