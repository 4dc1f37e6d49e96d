// What roads that somebody drew say of a cell.
#pragma once

namespace roadfix {

/// How sure a drawn map is. Map data is never perfect: a road may have gone, another may be missing.
struct Certainty {
  double on_road = 0.95;
  double elsewhere = 0.02;
  /// Of a cell of which `share` is covered by road.
  double probability(double share) const { return elsewhere + (on_road - elsewhere) * share; }
};

}  // namespace roadfix
