// The scale of a feature map whose altitude is known only roughly: the fourth dimension of a search.
#pragma once

namespace roadfix {

/// Natural logarithm of the largest factor of a scale range in [0, 1): the true size of the ground in a feature map is
/// 1 - range to 1 / (1 - range) times the stated one.
double max_log_scale(double range);

/// Factors exp(index * step) on the feature map's size, for |index| <= reach. Reach 0: the size is as it was given.
class Scales {
 public:
  Scales() = default;
  /// Over the range, in [0, 1); neighbours differ by at most a cell at the footprint's edge.
  static Scales for_footprint(double radius_m, double cell_m, double range);

  int reach() const { return reach_; }
  int count() const { return 2 * reach_ + 1; }
  double factor(int index) const;
  /// Index of the factor nearest to exp(log_factor).
  int nearest(double log_factor) const;
  /// The same range in steps `times` as fine: indices are multiplied by `times`.
  Scales finer(int times) const;

 private:
  Scales(double step, int reach) : step_(step), reach_(reach) {}
  double step_ = 0.0;
  int reach_ = 0;
};

}  // namespace roadfix
