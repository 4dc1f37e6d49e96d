#include "core/match/branch_and_bound.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <optional>

#include "core/grid/resample.hpp"
#include "core/match/bound_sums.hpp"
#include "core/match/bound_terms.hpp"
#include "core/match/footprint.hpp"
#include "core/match/kernel.hpp"
#include "core/match/score.hpp"
#include "core/match/score_bound.hpp"

namespace roadfix {
namespace {

constexpr int kTileRows = 16;       // of blocks; with kRun columns and the footprint's reach within a core's cache
constexpr int kSectorHeadings = 4;  // share what they cover of the map
constexpr std::size_t kBatch = std::size_t{1} << 20U;  // looked into before the best score is read again

struct Node {
  std::int32_t col = 0;  ///< block of the map
  std::int32_t row = 0;
  std::int32_t heading = 0;  ///< index into the headings searched
  float bound = 0.0F;
  /// Of the map under the footprint, where all of it is observed; else `whole` is false.
  std::uint32_t map_least = 0, map_most = 0, square_least = 0, square_most = 0;
  bool whole = false;
};

bool higher(const Node& a, const Node& b) { return a.bound > b.bound; }

/// Headings beside each other, and what any or all of them cover.
struct Sector {
  std::size_t first = 0;
  std::size_t last = 0;  ///< after the last heading
  std::vector<BlockRun> inner, outer;
  double outer_blocks = 0.0;
  BlockSums features;  ///< what holds for all of them; map sums are left out
};

struct Run {
  CoveredSums inner, outer;
};

class BranchAndBound {
 public:
  BranchAndBound(const BoundedSearch& search, const Deadline& deadline)
      : search_(search),
        deadline_(deadline),
        map_(*search.map),
        shift_col_(search.positions.origin.col - map_.geometry().origin.col),
        shift_row_(search.positions.origin.row - map_.geometry().origin.row),
        full_cells_(static_cast<double>(search.features->cells.observed_count())),
        base_(base_of(*search.features)),
        hints_(find_lines(*search.features, base_)) {}

  BoundedResult run() {
    best_ = search_.known;
    const bool scanned = turn() && scan();
    result_.complete = scanned && visit();
    constexpr double kHighestScore = 1.0;
    result_.bound = std::max(best_.load(), result_.complete ? 0.0 : scanned ? highest_left_ : kHighestScore);
    if (!result_.complete) result_.excluded_share = excluded_share();
    result_.visited = visited_;
    std::ranges::sort(result_.poses, std::ranges::greater{}, &LatticePose::score);
    return std::move(result_);
  }

 private:
  Angle heading(std::size_t index) const { return search_.bins.heading(search_.headings[index]); }
  double excluded_share() const {
    const auto blocks = [](int cells) { return std::ceil(static_cast<double>(cells) / kBlockCells); };
    const double all =
        blocks(search_.positions.cols) * blocks(search_.positions.rows) * static_cast<double>(search_.headings.size());
    return std::clamp((static_cast<double>(bounded_) - static_cast<double>(nodes_.size())) / all, 0.0, 1.0);
  }

  bool turn() {
    const std::size_t count = search_.headings.size();
    turned_.resize(count);
    std::atomic<bool> whole{true};
    parallel_for(static_cast<int>(count), search_.threads, [&](int i) {
      const auto at = static_cast<std::size_t>(i);
      if (deadline_.over()) {
        whole = false;
        return;
      }
      turned_[at].emplace(rotated(*search_.features, heading(at)), heading(at), base_, hints_, map_.span(),
                          map_.all_observed());
    });
    if (!whole) return false;
    for (std::size_t first = 0; first < count; first += kSectorHeadings) {
      sectors_.push_back(sector_of(first, std::min(first + kSectorHeadings, count)));
    }
    return true;
  }

  Sector sector_of(std::size_t first, std::size_t last) const {
    Sector sector{first, last, {}, {}, 0.0, {}};
    int side = 0;
    for (std::size_t i = first; i < last; ++i) side = std::max(side, turned_[i]->side);
    std::vector<bool> inner(static_cast<std::size_t>(side * side), true);
    std::vector<bool> outer(inner.size(), false);
    BlockSums& sums = sector.features;
    constexpr double kMost = std::numeric_limits<double>::max();
    sums.cells = {kMost, 0.0};
    sums.feature = {kMost, 0.0};
    sums.feature_square_least = kMost;
    sums.base = base_;
    sums.span = map_.span();
    for (std::size_t i = first; i < last; ++i) {
      const TurnedFeatures& turned = *turned_[i];
      for (int row = 0; row < side; ++row) {
        for (int col = 0; col < side; ++col) {
          const int inset = (side - turned.side) / 2;
          const int c = col - inset;
          const int r = row - inset;
          const bool within = c >= 0 && r >= 0 && c < turned.side && r < turned.side;
          const auto from = static_cast<std::size_t>(r * turned.side + c);
          const auto to = static_cast<std::size_t>(row * side + col);
          inner[to] = inner[to] && within && turned.inner[from];
          outer[to] = outer[to] || (within && turned.outer[from]);
        }
      }
      sums.cells = {std::min(sums.cells.least, turned.cells), std::max(sums.cells.most, turned.cells)};
      sums.feature = {std::min(sums.feature.least, turned.sum), std::max(sums.feature.most, turned.sum)};
      sums.feature_square_least = std::min(sums.feature_square_least, turned.square);
    }
    sector.inner = runs_of(inner, side);
    sector.outer = runs_of(outer, side);
    for (const BlockRun& run : sector.outer) sector.outer_blocks += run.last - run.first;
    return sector;
  }

  struct Tile {
    int col = 0;
    int row = 0;
    int rows = 0;
  };

  /// False if time was over.
  bool scan() {
    std::vector<Tile> tiles;
    const int first_col = shift_col_ / kBlockCells;
    const int first_row = shift_row_ / kBlockCells;
    const int last_col = (shift_col_ + search_.positions.cols - 1) / kBlockCells;
    const int last_row = (shift_row_ + search_.positions.rows - 1) / kBlockCells;
    for (int row = first_row; row <= last_row; row += kTileRows) {
      for (int col = first_col; col <= last_col; col += BoundMap::kRun) {
        tiles.push_back({col, row, std::min(kTileRows, last_row - row + 1)});
      }
    }
    for (std::size_t next = 0; next < tiles.size();) {
      const std::size_t end = std::min(next + static_cast<std::size_t>(search_.threads), tiles.size());
      std::atomic<bool> whole{true};
      parallel_for(static_cast<int>(end - next), search_.threads, [&](int i) {
        if (!scan_tile(tiles[next + static_cast<std::size_t>(i)])) whole = false;
      });
      // What is remembered must not grow without end.
      if (!whole || (nodes_.size() > kBatch && !visit())) return false;
      next = end;
    }
    return true;
  }

  bool block_eligible(int col, int row) const {
    for (int i = 0; i < kBlockCells * kBlockCells; ++i) {
      const int c = col * kBlockCells + i % kBlockCells - shift_col_;
      const int r = row * kBlockCells + i / kBlockCells - shift_row_;
      if (cell_eligible(c, r)) return true;
    }
    return false;
  }
  bool cell_eligible(int col, int row) const {
    return col >= 0 && row >= 0 && col < search_.positions.cols && row < search_.positions.rows &&
           search_.eligible(col, row);
  }

  /// What the map holds under a block of the run, for all headings of the sector.
  BlockSums sums_of(const Sector& sector, const Run& run, std::size_t i, bool& whole) const {
    BlockSums sums = sector.features;
    sums.map = {static_cast<double>(run.inner.value[i]), static_cast<double>(run.outer.value[i])};
    sums.map_square = {static_cast<double>(run.inner.square[i]), static_cast<double>(run.outer.square[i])};
    whole = run.outer.cells[i] == sector.outer_blocks * kBlockCells * kBlockCells;
    if (!whole) {
      sums.cells = {static_cast<double>(run.inner.cells[i]),
                    std::min(sums.cells.most, static_cast<double>(run.outer.cells[i]))};
      sums.feature.least = 0.0;
      sums.feature_square_least = 0.0;
    }
    return sums;
  }

  bool scan_tile(const Tile& tile) {
    std::vector<Node> nodes;
    std::int64_t blocks = 0;
    std::vector<Run> runs(static_cast<std::size_t>(tile.rows));
    std::vector<std::array<double, BoundMap::kRun>> needed(runs.size());
    std::vector<std::array<bool, BoundMap::kRun>> eligible(runs.size());
    for (int r = 0; r < tile.rows; ++r) {
      for (int i = 0; i < BoundMap::kRun; ++i) {
        eligible[static_cast<std::size_t>(r)][static_cast<std::size_t>(i)] = block_eligible(tile.col + i, tile.row + r);
      }
    }
    for (const Sector& sector : sectors_) {
      if (deadline_.over()) return false;
      const double goal = best_;
      std::vector<bool> hopeless(runs.size(), true);
      for (std::size_t r = 0; r < runs.size(); ++r) {
        const int row = tile.row + static_cast<int>(r);
        covered_sums(map_, sector.inner, tile.col, row, runs[r].inner);
        covered_sums(map_, sector.outer, tile.col, row, runs[r].outer);
        for (std::size_t i = 0; i < BoundMap::kRun; ++i) {
          needed[r][i] = std::numeric_limits<double>::infinity();
          if (!eligible[r][i]) continue;
          bool whole = false;
          const BlockSums sums = sums_of(sector, runs[r], i, whole);
          needed[r][i] = cross_needed(sums, full_cells_, search_.least_cells, goal);
          const double most = (kRoad - base_) * sums.map.most;
          if (needed[r][i] <= most) hopeless[r] = false;
        }
      }
      for (std::size_t h = sector.first; h < sector.last; ++h) {
        for (std::size_t r = 0; r < runs.size(); ++r) {
          if (hopeless[r]) continue;
          blocks += BoundMap::kRun;
          scan_run(sector, h, tile.col, tile.row + static_cast<int>(r), runs[r], needed[r], nodes);
        }
      }
    }
    const std::lock_guard lock(mutex_);
    nodes_.insert(nodes_.end(), nodes.begin(), nodes.end());
    result_.blocks += blocks;
    for (const auto& run : eligible) bounded_ += std::ranges::count(run, true) * std::ssize(search_.headings);
    return true;
  }

  void scan_run(const Sector& sector, std::size_t h, int col, int row, const Run& run,
                const std::array<double, BoundMap::kRun>& needed, std::vector<Node>& nodes) {
    const TurnedFeatures& turned = *turned_[h];
    RunSums cross;
    term_sums(map_, turned.cross, col, row, cross);
    bool partial_known = false;
    RunSums sum_least;
    RunSums sum_most;
    RunSums square_least;
    for (std::size_t i = 0; i < BoundMap::kRun; ++i) {
      const double most = cross[i] * turned.cross.unit;
      if (most < needed[i]) continue;
      bool whole = false;
      BlockSums sums = sums_of(sector, run, i, whole);
      sums.cross_most = most;
      if (whole) {
        sums.cells = {turned.cells, turned.cells};
        sums.feature = {turned.sum, turned.sum};
        sums.feature_square_least = turned.square;
      } else {
        if (!partial_known) {
          partial_known = true;
          term_sums(map_, turned.sum_least, col, row, sum_least);
          term_sums(map_, turned.sum_most, col, row, sum_most);
          term_sums(map_, turned.square_least, col, row, square_least);
        }
        sums.cells.most = std::min(sums.cells.most, turned.cells);
        sums.feature = {sum_least[i] * turned.sum_least.unit, std::min(turned.sum, sum_most[i] * turned.sum_most.unit)};
        sums.feature_square_least = square_least[i] * turned.square_least.unit;
      }
      const double bound = score_bound(sums, full_cells_, search_.least_cells);
      if (bound <= best_) continue;
      Node node{col + static_cast<std::int32_t>(i), row, static_cast<std::int32_t>(h),
                std::nextafter(static_cast<float>(bound), 2.0F)};
      node.map_least = run.inner.value[i];
      node.map_most = run.outer.value[i];
      node.square_least = run.inner.square[i];
      node.square_most = run.outer.square[i];
      node.whole = whole;
      nodes.push_back(node);
    }
  }

  /// Best first, until nothing can be better than what was found; false if time was over before.
  bool visit() {
    std::erase_if(nodes_, [&](const Node& node) { return static_cast<double>(node.bound) <= best_; });
    std::ranges::sort(nodes_, higher);
    std::size_t next = 0;
    while (next < nodes_.size() && static_cast<double>(nodes_[next].bound) > best_) {
      highest_left_ = static_cast<double>(nodes_[next].bound);
      if (deadline_.over()) return false;
      const std::size_t end = std::min(next + kBatch, nodes_.size());
      const std::vector<Node> batch(nodes_.begin() + static_cast<std::ptrdiff_t>(next),
                                    nodes_.begin() + static_cast<std::ptrdiff_t>(end));
      if (!look_into(batch)) return false;
      next = end;
    }
    nodes_.clear();
    return true;
  }

  /// Calls work(heading, nodes of it); false if time was over before all were called.
  template <typename Work>
  bool for_headings(const std::vector<Node>& nodes, Work work) {
    std::map<std::int32_t, std::vector<Node>> of_heading;
    for (const Node& node : nodes) of_heading[node.heading].push_back(node);
    std::vector<std::pair<std::int32_t, std::vector<Node>>> tasks(of_heading.begin(), of_heading.end());
    std::atomic<bool> whole{true};
    parallel_for(static_cast<int>(tasks.size()), search_.threads, [&](int t) {
      if (deadline_.over()) {
        whole = false;
        return;
      }
      const auto& [h, members] = tasks[static_cast<std::size_t>(t)];
      work(static_cast<std::size_t>(h), members);
    });
    return whole;
  }

  /// Adds the best pose of each node that has one better than what is known.
  bool look_into(const std::vector<Node>& nodes) {
    visited_ += static_cast<std::int64_t>(nodes.size());
    return for_headings(nodes, [&](std::size_t h, const std::vector<Node>& members) {
      const std::vector<LatticePose> poses = best_poses(h, members);
      const std::lock_guard lock(mutex_);
      result_.poses.insert(result_.poses.end(), poses.begin(), poses.end());
      for (const LatticePose& pose : poses) best_ = std::max(best_.load(), pose.score);
    });
  }

  /// Positions of a node that are left: side x side cells from (col, row) on.
  struct Part {
    std::size_t node = 0;
    int col = 0;
    int row = 0;
    BlockSums sums;
  };

  std::vector<LatticePose> best_poses(std::size_t h, const std::vector<Node>& nodes) const {
    const FeatureMap turned = rotated(*search_.features, heading(h));
    const Footprint above(above_base(turned, base_));
    std::vector<Part> parts = parts_of(h, nodes);
    parts = surviving(std::move(parts), above, kBlockCells);
    parts = surviving(halves(parts), above, kBlockCells / 2);
    std::vector<PlaneCell> places;
    std::vector<std::size_t> owners;
    for (const Part& part : parts) {
      for (int i = 0; i < kBlockCells; ++i) {
        const PlaneCell place{part.col + i % 2, part.row + i / 2};
        if (!cell_eligible(place.col - shift_col_, place.row - shift_row_)) continue;
        places.push_back(place);
        owners.push_back(part.node);
      }
    }
    std::vector<MatchSums> sums(places.size());
    match_sums(map_.exact(), Footprint(turned), places, sums);
    std::map<std::size_t, LatticePose> best;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double score = score_of(sums[i], static_cast<std::int64_t>(full_cells_), search_.least_cells);
      if (score <= 0.0) continue;
      const LatticeIndex origin = map_.geometry().origin;
      LatticePose& pose = best[owners[i]];
      if (score > pose.score) {
        pose = {{origin.col + places[i].col, origin.row + places[i].row}, search_.headings[h], score};
      }
    }
    std::vector<LatticePose> poses;
    for (const auto& [node, pose] : best) {
      if (pose.score > best_) poses.push_back(pose);
    }
    return poses;
  }

  std::vector<Part> parts_of(std::size_t h, const std::vector<Node>& nodes) const {
    std::vector<Part> parts;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      parts.push_back({i, kBlockCells * nodes[i].col, kBlockCells * nodes[i].row, sums_at(h, nodes[i])});
    }
    return parts;
  }

  static std::vector<Part> halves(const std::vector<Part>& parts) {
    std::vector<Part> result;
    for (const Part& part : parts) {
      for (int i = 0; i < 4; ++i) {
        Part half = part;
        half.col += kBlockCells / 2 * (i % 2);
        half.row += kBlockCells / 2 * (i / 2);
        result.push_back(half);
      }
    }
    return result;
  }

  std::vector<Part> surviving(std::vector<Part> parts, const Footprint& above, int side) const {
    std::vector<PlaneCell> places;
    for (const Part& part : parts) places.push_back({part.col, part.row});
    std::vector<MatchSums> sums(places.size());
    match_sums(map_.pooled(side), above, places, sums);
    std::vector<Part> result;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      Part& part = parts[i];
      part.sums.cross_most = sums[i].ml * (kRoad * kRoad) + 0.5;  // whole numbers, but for rounding
      if (score_bound(part.sums, full_cells_, search_.least_cells) > best_) result.push_back(part);
    }
    return result;
  }

  /// What is known of a block without its cross sum.
  BlockSums sums_at(std::size_t h, const Node& node) const {
    const Sector& sector = sectors_[h / kSectorHeadings];
    const TurnedFeatures& turned = *turned_[h];
    if (node.whole) {
      BlockSums sums = sector.features;
      sums.map = {static_cast<double>(node.map_least), static_cast<double>(node.map_most)};
      sums.map_square = {static_cast<double>(node.square_least), static_cast<double>(node.square_most)};
      sums.cells = {turned.cells, turned.cells};
      sums.feature = {turned.sum, turned.sum};
      sums.feature_square_least = turned.square;
      return sums;
    }
    Run run;
    covered_sums(map_, sector.inner, node.col, node.row, run.inner);
    covered_sums(map_, sector.outer, node.col, node.row, run.outer);
    bool whole = false;
    BlockSums sums = sums_of(sector, run, 0, whole);
    const auto at = [&](const BoundTerms& terms) {
      RunSums values;
      term_sums(map_, terms, node.col, node.row, values);
      return values[0] * terms.unit;
    };
    sums.cells.most = std::min(sums.cells.most, turned.cells);
    sums.feature = {at(turned.sum_least), std::min(turned.sum, at(turned.sum_most))};
    sums.feature_square_least = at(turned.square_least);
    return sums;
  }

  const BoundedSearch& search_;
  const Deadline& deadline_;
  const BoundMap& map_;
  int shift_col_;  ///< of the positions within the map, cells
  int shift_row_;
  double full_cells_;
  int base_;
  LineHints hints_;
  std::vector<std::optional<TurnedFeatures>> turned_;
  std::vector<Sector> sectors_;
  std::atomic<double> best_{0.0};
  std::atomic<std::int64_t> visited_{0};
  std::mutex mutex_;
  std::vector<Node> nodes_;
  std::int64_t bounded_ = 0;  ///< blocks x headings
  double highest_left_ = 0.0;
  BoundedResult result_;
};

}  // namespace

BoundedResult search_with_bound(const BoundedSearch& search, const Deadline& deadline) {
  if (search.headings.empty() || search.positions.cols <= 0 || search.positions.rows <= 0) return {};
  return BranchAndBound(search, deadline).run();
}

}  // namespace roadfix
