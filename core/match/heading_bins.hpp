// Headings as integers: a full turn in an even number of equal bins, which the next finer level halves.
#pragma once

#include <numbers>

#include "core/units/angle.hpp"

namespace roadfix {

class HeadingBins {
 public:
  /// Bins so fine that the edge of a footprint, `radius_m` from its nadir, moves by at most `cell_m` from one to the
  /// next.
  static HeadingBins for_footprint(double radius_m, double cell_m);
  explicit HeadingBins(int count) : count_(count) {}

  int count() const { return count_; }
  Angle step() const { return Angle::radians(2.0 * std::numbers::pi / count_); }
  Angle heading(int bin) const { return Angle::radians(2.0 * std::numbers::pi * bin / count_); }
  /// The bin whose heading is nearest.
  int nearest(Angle heading) const;
  int wrapped(int bin) const { return ((bin % count_) + count_) % count_; }
  /// Bins between two, the shorter way round.
  int distance(int a, int b) const;
  HeadingBins halved() const { return HeadingBins(2 * count_); }
  /// With up to three bins more, so that a quarter turn is a whole number of them.
  HeadingBins in_quarters() const { return HeadingBins((count_ + 3) / 4 * 4); }

 private:
  int count_;
};

}  // namespace roadfix
