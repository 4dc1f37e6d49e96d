// What a user may choose of a rendered world, and where it lies on the Earth.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/geodesy/latlon.hpp"
#include "core/geodesy/utm.hpp"

namespace roadfix::world {

enum class Land { kTown, kCountry };

struct WorldSettings {
  std::uint64_t seed = 1;
  Land land = Land::kTown;
  double width_m = 2000.0;
  double height_m = 2000.0;
  double gsd_m = 0.5;
  /// Of the pictures; by default a town in south-eastern Anatolia, or the middle of `roads` (of several
  /// files, of the first).
  std::optional<LatLon> centre;
  /// File, folder or ZIP archive of road lines to render instead of invented ones; empty to invent them.
  std::string roads;
  double collapsed_share = 0.1;  ///< of the buildings
  bool varied = false;           ///< sun, air, season and camera drawn from the seed instead of the two usual days
  int frames = 8;
  double footprint_m = 400.0;  ///< side of the square that a frame shows
};

inline constexpr LatLon kDefaultCentre{37.7640, 38.2760};

/// Throws InvalidInput ("parameter-out-of-range", "world-land-roads", "world-too-small-for-frames").
void check(const WorldSettings& settings);

/// Pixels of both pictures on the plane of their zone.
struct Placement {
  UtmZone zone;
  double gsd_m = 0.5;
  int cols = 0;
  int rows = 0;
  GridPoint north_west;

  GridPoint point_of(double col, double row) const {
    return {north_west.east_m + col * gsd_m, north_west.north_m - row * gsd_m};
  }
};

/// The corner lies on a whole number of pixels of the zone's plane.
Placement place(const WorldSettings& settings, LatLon centre);

}  // namespace roadfix::world
