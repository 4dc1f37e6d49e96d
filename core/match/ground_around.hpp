// The map below poses: one plane for all where they lie so close together that it is no larger than one for each.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/match/deadline.hpp"
#include "core/match/kernel.hpp"
#include "core/match/lattice_pose.hpp"
#include "core/match/level.hpp"
#include "core/match/map_plane.hpp"

namespace roadfix {

/// Wide enough for the footprint at a pose, at the next larger scale too, and at those up to `cells` away.
GridGeometry window_around(const Level& level, const LatticePose& pose, int cells);

/// The places up to `reach` steps of so many cells away along either axis, row by row.
std::vector<PlaneCell> places_around(PlaneCell place, int reach, int step = 1);

class GroundAround {
 public:
  /// `complete()` is false, and the rest must not be used, if time was over before.
  GroundAround(const Level& level, int cells, const Deadline& deadline, const std::vector<LatticePose>& poses);

  bool complete() const { return complete_; }
  /// Of a cell of the level around that pose.
  PlaneCell place(std::size_t pose, LatticeIndex cell) const;
  /// match_sums() at places around some of the poses, equally many around each, one pose after the other.
  void match(const PackedFootprint& footprint, std::span<const std::size_t> poses, std::span<const PlaneCell> places,
             std::span<MatchSums> sums) const;

 private:
  struct Plane {
    LatticeIndex origin;
    MapPlane plane;
  };
  bool shared() const { return planes_.size() == 1; }
  const Plane& at(std::size_t pose) const { return planes_[shared() ? 0 : pose]; }

  std::vector<Plane> planes_;
  bool complete_ = false;
};

}  // namespace roadfix
