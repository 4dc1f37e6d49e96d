#include "core/proof/branch_and_bound.hpp"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include "core/proof/block_scan.hpp"
#include "core/proof/block_visit.hpp"
#include "core/proof/heading_sectors.hpp"
#include "core/units/parallel_for.hpp"

namespace roadfix {
namespace {

constexpr std::size_t kBatch = std::size_t{1} << 19U;  // nodes visited before the best score is read again

bool higher(const BoundNode& a, const BoundNode& b) { return a.bound > b.bound; }

class BranchAndBound {
 public:
  BranchAndBound(const BoundedSearch& search, const Deadline& deadline)
      : search_(search),
        deadline_(deadline),
        problem_(search),
        headings_(problem_),
        floor_(search.known),
        block_scan_(problem_, headings_, floor_),
        block_visit_(problem_, floor_) {}

  BoundedResult run() {
    const bool scanned = headings_.turn(deadline_) && scan();
    result_.complete = scanned && visit();
    constexpr double kHighestScore = 1.0;
    const double best = result_.better ? result_.better->score : search_.known;
    result_.bound = std::max(best, result_.complete ? 0.0 : scanned ? highest_left_ : kHighestScore);
    if (!result_.complete) result_.excluded_share = excluded_share();
    return result_;
  }

 private:
  double excluded_share() const {
    std::int64_t all = 0;
    for (const BlockTile& tile : block_scan_.tiles()) all += block_scan_.eligible(tile);
    return all > 0 ? static_cast<double>(bounded_ - std::ssize(nodes_)) / static_cast<double>(all) : 1.0;
  }

  /// False if time was over.
  bool scan() {
    const std::vector<BlockTile> tiles = block_scan_.tiles();
    for (std::size_t next = 0; next < tiles.size();) {
      const std::size_t end = std::min(next + static_cast<std::size_t>(std::max(1, search_.threads)), tiles.size());
      std::atomic<bool> complete{true};
      parallel_for(static_cast<int>(end - next), search_.threads, [&](int i) {
        const BlockScanResult found = block_scan_.scan(tiles[next + static_cast<std::size_t>(i)], deadline_);
        if (!found.complete) complete = false;
        add(found);
      });
      // Visits nodes early if there are many, to bound memory.
      if (!complete || (nodes_.size() > kBatch && !visit())) return false;
      next = end;
    }
    return true;
  }

  void add(const BlockScanResult& found) {
    const std::lock_guard lock(mutex_);
    nodes_.insert(nodes_.end(), found.nodes.begin(), found.nodes.end());
    bounded_ += found.eligible;
  }

  /// Best first, until none of the nodes can hold a better pose than the best one found. False if time ran out.
  bool visit() {
    std::erase_if(nodes_, [&](const BoundNode& node) { return static_cast<double>(node.bound) <= floor_; });
    std::ranges::sort(nodes_, higher);
    std::size_t next = 0;
    while (next < nodes_.size() && static_cast<double>(nodes_[next].bound) > floor_) {
      highest_left_ = static_cast<double>(nodes_[next].bound);
      if (deadline_.over()) return false;
      const std::size_t end = std::min(next + kBatch, nodes_.size());
      const std::vector<BoundNode> batch(nodes_.begin() + static_cast<std::ptrdiff_t>(next),
                                         nodes_.begin() + static_cast<std::ptrdiff_t>(end));
      if (!look_into(batch)) return false;
      next = end;
    }
    nodes_.clear();
    return true;
  }

  /// False if time ran out.
  bool look_into(const std::vector<BoundNode>& nodes) {
    std::map<std::int32_t, std::vector<BoundNode>> of_heading;
    for (const BoundNode& node : nodes) of_heading[node.heading].push_back(node);
    const std::vector<std::pair<std::int32_t, std::vector<BoundNode>>> tasks(of_heading.begin(), of_heading.end());
    std::atomic<bool> complete{true};
    parallel_for(static_cast<int>(tasks.size()), search_.threads, [&](int t) {
      if (deadline_.over()) {
        complete = false;
        return;
      }
      const auto& [heading, members] = tasks[static_cast<std::size_t>(t)];
      const auto best = block_visit_.best_pose(static_cast<std::size_t>(heading), members);
      if (best) take_if_better(*best);
    });
    return complete;
  }

  void take_if_better(const LatticePose& pose) {
    const std::lock_guard lock(mutex_);
    if (result_.better && !is_better(pose, *result_.better)) return;
    result_.better = pose;
    floor_ = std::nextafter(pose.score, 0.0);  // poses of the same score may come before it in the order
  }

  const BoundedSearch& search_;
  const Deadline& deadline_;
  BoundProblem problem_;
  HeadingSectors headings_;
  std::atomic<double> floor_;  ///< what a pose has to exceed
  BlockScan block_scan_;
  BlockVisit block_visit_;
  std::mutex mutex_;
  std::vector<BoundNode> nodes_;
  std::int64_t bounded_ = 0;  ///< blocks x headings
  double highest_left_ = 0.0;
  BoundedResult result_;
};

}  // namespace

BoundedResult search_with_bound(const BoundedSearch& search, const Deadline& deadline) {
  assert(!search.headings.empty() && search.positions.cols > 0 && search.positions.rows > 0);
  return BranchAndBound(search, deadline).run();
}

}  // namespace roadfix
