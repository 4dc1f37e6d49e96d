// The map below poses: one plane for all where they lie so close together that it is no larger than one for each.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/match/deadline.hpp"
#include "core/match/kernel.hpp"
#include "core/match/lattice_pose.hpp"
#include "core/match/quarter_planes.hpp"
#include "core/search/level.hpp"

namespace roadfix {

/// Wide enough for the footprint at a pose, at the next larger scale too, and at those up to `cells` away.
GridGeometry window_around(const Level& level, const LatticePose& pose, int cells);

/// The places up to `reach` steps of so many cells away along either axis, row by row.
std::vector<PlaneCell> places_around(PlaneCell place, int reach, int step = 1);

/// What ground around poses will be matched with: footprints up to so many cells away, turned to so many headings.
struct GroundUse {
  int cells = 0;
  int headings = 0;
};

class GroundAround {
 public:
  /// The ground of the footprint at each pose, at the next larger scale too. Where it is turned to many headings, those
  /// a quarter turn apart share one. `complete()` is false, and the rest must not be used, if time was over before.
  GroundAround(const Level& level, GroundUse use, const Deadline& deadline, const std::vector<LatticePose>& poses);

  bool complete() const { return complete_; }
  /// Whether match() takes quarters beyond 0.
  bool rotated() const { return shared() && planes_.front().quarters.rotated(); }
  /// The sums at cells of the level, each around one of the poses, for a footprint turned by so many quarters to the
  /// right. Cells around one pose follow each other.
  void match(const PackedFootprint& footprint, int quarters, std::span<const std::size_t> poses,
             std::span<const LatticeIndex> cells, std::span<MatchSums> sums) const;

 private:
  struct Plane {
    LatticeIndex origin;
    QuarterPlanes quarters;
  };
  bool shared() const { return planes_.size() == 1; }
  const Plane& at(std::size_t pose) const { return planes_[shared() ? 0 : pose]; }

  std::vector<Plane> planes_;
  bool complete_ = false;
};

}  // namespace roadfix
