// How high a planned flight is above the ground, and how much ground a frame shows from there.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/locate/map_view.hpp"
#include "core/routes/route.hpp"
#include "core/units/angle.hpp"

namespace roadfix {

/// A camera that looks straight down, without distortion.
struct DownwardCamera {
  Angle horizontal_fov;       ///< across a frame; above 0, below 180 degrees
  double aspect = 4.0 / 3.0;  ///< width of a frame over its height

  /// Side of the square that is as large as the ground of a frame; 0 on the ground and below.
  double footprint_m(double agl_m) const;
};

/// Straight from place to place: above the sea, or where both ends count from the ground, above that.
///
/// Heights above the home count from its ground as the map knows it, so that what its heights err by cancels, else from
/// how high the plan says that it lies; and on a map that knows no heights of its ground, as if that were level.
class FlightHeights {
 public:
  /// `usual_agl_m`: of places without a height. Throws InvalidInput "heights-missing" where there is such a place and
  /// none is usual, "terrain-missing" where a height is none above ground and the map cannot make it one.
  FlightHeights(const MapView& map, const routes::Route& route, std::optional<double> usual_agl_m);

  /// On the way from a place, by its number, to the next: a share of it behind, from 0 to 1, over `point`. Not above 0
  /// where the plan leads into the ground; nullopt where the map does not know its height.
  std::optional<double> agl_m(std::size_t from, double share, GridPoint point) const;

 private:
  struct Height {
    std::optional<double> agl_m;        ///< where it is told so
    std::optional<double> above_sea_m;  ///< where it is told so, or the ground is known
  };

  Height height_of(const routes::Route& route, const routes::RoutePlace& place,
                   std::optional<double> usual_agl_m) const;
  double home_ground_m(const routes::RouteHome& home) const;
  std::optional<double> ground_m(LatLon place) const;

  const MapView& map_;
  std::vector<Height> places_;
};

}  // namespace roadfix
