#include "tiles/roads/line_counts.hpp"

namespace roadfix {

LineCounts& LineCounts::operator+=(const LineCounts& more) {
  if (impossible == 0) first_impossible = more.first_impossible;
  lines += more.lines;
  impossible += more.impossible;
  without_geometry += more.without_geometry;
  for (const auto& [name, count] : more.unknown_classes) unknown_classes[name] += count;
  without_class += more.without_class;
  roads_without_class += more.roads_without_class;
  return *this;
}

}  // namespace roadfix
