// A map in memory behind the port that localization reads through.
#pragma once

#include "core/locate/map_view.hpp"
#include "tests/support/street_map.hpp"

namespace roadfix::testing {

/// In UTM zone 34 north; the extent is the whole grid.
inline MapView view_of(const RoadGrid& map) {
  return {{"town", "1"},
          UtmZone::from_epsg(32634).value(),
          map.geometry.cell_m,
          map.geometry.box(),
          {},
          [](GridPoint) { return 0.0; },
          reader_of(map)};
}

}  // namespace roadfix::testing
