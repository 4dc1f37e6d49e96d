// Indices side by side: columns, rows, steps.
#pragma once

namespace roadfix {

/// first <= i < end; empty where end <= first.
struct IndexRange {
  int first = 0;
  int end = 0;

  int count() const { return end - first; }
  bool contains(int i) const { return first <= i && i < end; }
};

}  // namespace roadfix
