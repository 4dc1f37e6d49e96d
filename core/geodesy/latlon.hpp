// WGS 84 geographic position.
#pragma once

namespace roadfix {

/// Latitude in [-90, 90], longitude in [-180, 180), degrees, WGS 84.
struct LatLon {
  double lat_deg = 0.0;
  double lon_deg = 0.0;
};

}  // namespace roadfix
