// From poses of the finest level to modes: one for each peak, located within the cell.
#pragma once

#include <cstddef>
#include <vector>

#include "core/match/deadline.hpp"
#include "core/search/level.hpp"

namespace roadfix {

class ModeFinder {
 public:
  /// All outlive it. `background`: its spread tells how sharp a peak is.
  ModeFinder(const Level& finest, const ScoreBackground& background, const Deadline& deadline)
      : finest_(finest), bins_(finest.bins.halved()), background_(background), deadline_(deadline) {}

  /// The peak that the pose is a flank of, at most three moves uphill away.
  SearchMode at(LatticePose pose) const;
  /// The first `count` peaks of `poses` (best first); best first. At the deadline it ends, but not before it has one.
  std::vector<SearchMode> first_of(const std::vector<LatticePose>& poses, std::size_t count);
  /// Whether one lies within the window of scores that give the other's shape.
  bool on_one_peak(const SearchMode& a, const SearchMode& b) const;
  /// Whether no first_of() was ended by the deadline.
  bool in_time() const { return in_time_; }

 private:
  const Level& finest_;
  HeadingBins bins_;  ///< half as wide as those of the level
  const ScoreBackground& background_;
  const Deadline& deadline_;
  bool in_time_ = true;
};

}  // namespace roadfix
