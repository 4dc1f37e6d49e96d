// Relief displacement: in a picture that was rectified to the level of the ground below the camera, ground that lies
// higher is shown farther from the nadir than it is, ground that lies lower, nearer.
#pragma once

#include "core/grid/feature_map.hpp"
#include "core/grid/terrain.hpp"

namespace roadfix {

class Relief {
 public:
  /// Seen from so high above the ground below `pose`. `terrain` outlives it; where it knows no height the ground is
  /// taken to be level.
  Relief(const Terrain& terrain, const GridPose& pose, double agl_m);

  /// So many times as far from the nadir as it lies the ground is shown that lies so far to its right and behind it;
  /// 0.5 to 2.
  double stretch_of(double right_m, double back_m) const;
  /// Likewise, of the ground that is shown there.
  double stretch_at(double right_m, double back_m) const;
  /// The farthest that anything of what a feature map shows is shown from where it lies, as seen along its edges.
  double largest_shift_m(const FeatureMap& features) const;

 private:
  const Terrain* terrain_;
  GridPoint nadir_;
  double sin_, cos_;
  double agl_m_;
  double level_m_;  ///< height of the ground that is shown where it lies; NaN = unknown
};

/// `features` as if the ground were level: all of it lies where it is shown.
FeatureMap levelled(const FeatureMap& features, const Relief& relief);

/// The reverse: how a camera shows ground of which `ground` holds what lies where. cols x rows cells around the nadir.
FeatureMap shown_in_relief(const FeatureMap& ground, const Relief& relief, int cols, int rows);

}  // namespace roadfix
