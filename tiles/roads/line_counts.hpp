// What was counted of lines that may be roads, in a layer or in all of them.
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace roadfix {

struct LineCounts {
  std::int64_t lines = 0;
  std::int64_t impossible = 0;                          ///< besides, those with coordinates of no place on Earth
  std::string first_impossible;                         ///< which of the features
  std::int64_t without_geometry = 0;                    ///< besides, features that would be roads if they lay anywhere
  std::map<std::string, std::int64_t> unknown_classes;  ///< lines of classes that the rules do not know
  std::int64_t without_class = 0;                       ///< lines of layers with classes
  std::int64_t roads_without_class = 0;                 ///< those of them that nothing calls a river or the like

  LineCounts& operator+=(const LineCounts& more);
};

}  // namespace roadfix
