// A feature map made ready to be rotated to many headings.
#pragma once

#include "core/grid/bilinear_kernel.hpp"
#include "core/grid/feature_map.hpp"

namespace roadfix {

/// Thread-safe.
class FeatureRotator {
 public:
  explicit FeatureRotator(const FeatureMap& map);

  /// As rotated() of core/grid/resample.hpp.
  FeatureMap rotated(Angle heading) const;

 private:
  double cols_, rows_;
  double cell_m_;
  GridGeometry::CellPosition nadir_;
  BilinearSource source_;
};

}  // namespace roadfix
