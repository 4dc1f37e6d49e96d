// A window of a map: the cells under a footprint placed at a pose, as a client asks for them and gets them.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/geodesy/geo_pose.hpp"
#include "core/grid/feature_map.hpp"
#include "core/locate/map_view.hpp"
#include "server/api/fields.hpp"
#include "server/api/limits.hpp"

namespace roadfix::api {

struct WindowRequest {
  LatLon centre;
  std::optional<Angle> heading;  ///< true; nullopt = along the map's grid, so that no cell is resampled
  double width_m = 0.0;
  double height_m = 0.0;
  std::optional<double> cell_m;  ///< nullopt = the map's
};

const std::vector<std::string>& window_fields();
WindowRequest parse_window(const Fields& fields);

struct Window {
  FeatureMap cells;
  GridPose grid_pose;  ///< of the window's centre
  GeoPose pose;
  UtmZone zone;
  MapId map;
};

/// Throws InvalidInput ("window-outside-map") or LimitExceeded ("too-many-cells").
Window cut_window(const MapView& map, const WindowRequest& request, const Limits& limits);

/// Cells as base64, pose, map, footprint as GeoJSON. POST .../fix and .../match take it as it is.
nlohmann::json to_json(const Window& window);

/// GDAL's six coefficients from (column, row) to the zone's east and north, rotated with the window.
std::array<double, 6> geotransform(const Window& window);

}  // namespace roadfix::api
