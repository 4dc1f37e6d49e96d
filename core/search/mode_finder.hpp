// From poses of the finest level to modes: the peak within the cell, and one mode for each peak.
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

  /// The peak that a pose is a flank of, up to three steps away.
  SearchMode at(LatticePose pose) const;
  /// The first `count` peaks of poses that are best first; best first. At the deadline it ends after the first.
  std::vector<SearchMode> first_of(const std::vector<LatticePose>& poses, std::size_t count);
  /// Whether one lies among the scores that tell the other's shape.
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
