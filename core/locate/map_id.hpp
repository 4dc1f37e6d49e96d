// Which map, and as of when.
#pragma once

#include <string>

namespace roadfix {

struct MapId {
  std::string name;
  std::string version;  ///< changes whenever the cells of the map change
};

}  // namespace roadfix
