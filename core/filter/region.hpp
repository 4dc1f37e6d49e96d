// Where particles may live (the paper's acceptance region), and where new ones are drawn uniformly.
#pragma once

#include <optional>

#include "core/filter/particles.hpp"
#include "core/filter/random.hpp"

namespace roadfix {

struct AcceptanceRegion {
  GridBox box;                       ///< not empty
  std::optional<GridCircle> circle;  ///< intersects the box in more than a point
  Angle heading;                     ///< centre of the range
  Angle heading_half_width = Angle::degrees(180.0);
  double beyond_m = 0.0;  ///< so far outside particles live on, though none is drawn there

  bool contains(GridPoint point) const;
  /// Whether a particle that has come there lives on.
  bool keeps(GridPoint point) const;
  /// Uniform over the region and its headings, without drift.
  ParticleState draw(RandomStream& random) const;
};

}  // namespace roadfix
