// The map below poses: one plane for all of them if that is no larger than one for each together.
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

/// Wide enough for the footprint at the pose and up to `cells` away, and at the next larger scale.
GridGeometry window_around(const Level& level, const LatticePose& pose, int cells);

/// The (2 reach + 1)^2 places up to `reach` steps away along either axis, row by row; a step is `step` cells.
std::vector<PlaneCell> places_around(PlaneCell place, int reach, int step = 1);

/// What the ground will be used for.
struct GroundUse {
  int cells = 0;     ///< footprints are up to so many cells away from the poses
  int headings = 0;  ///< how many there are in all
};

class GroundAround {
 public:
  /// Reads the ground of the footprint at each pose, also at the next larger scale. For many headings it is kept in
  /// four orientations, so that headings a quarter turn apart share a footprint. If time runs out, complete() is false
  /// and nothing else may be called.
  GroundAround(const Level& level, GroundUse use, const Deadline& deadline, const std::vector<LatticePose>& poses);

  bool complete() const { return complete_; }
  /// Whether match() takes quarters other than 0.
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
