// WGS 84 geographic position.
#pragma once

namespace roadfix {

/// Latitude in [-90, 90], longitude in [-540, 540], degrees, WGS 84. Longitudes a turn apart are one place; zones give
/// those in [-180, 180].
struct LatLon {
  double lat_deg = 0.0;
  double lon_deg = 0.0;
};

}  // namespace roadfix
