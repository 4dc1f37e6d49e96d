// A feature map made ready to be turned to many headings.
#pragma once

#include "core/grid/bilinear_kernel.hpp"
#include "core/grid/feature_map.hpp"

namespace roadfix {

/// Thread-safe.
class TurnableMap {
 public:
  explicit TurnableMap(const FeatureMap& map);

  /// What rotated() gives.
  FeatureMap at(Angle heading) const;

 private:
  double cols_, rows_;
  double cell_m_;
  GridGeometry::CellPosition nadir_;
  BilinearSource source_;
};

}  // namespace roadfix
