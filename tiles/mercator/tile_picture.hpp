// Web-Mercator pictures of a map, rendered from its metric grid.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/locate/map_view.hpp"
#include "tiles/mercator/web_mercator.hpp"

namespace roadfix::mercator {

enum class TileStyle {
  kColour,  ///< roads bright and opaque, open ground faint: to lie over imagery
  kGrey     ///< grey = probability x 254, opaque where observed
};

/// PNG of 256 x 256 pixels, transparent where unobserved; nullopt where nothing was observed at all.
std::optional<std::vector<std::byte>> tile_png(const MapView& map, TileAddress tile, TileStyle style);

/// The zoom at which a pixel is about a cell.
int native_zoom(const MapView& map);

}  // namespace roadfix::mercator
