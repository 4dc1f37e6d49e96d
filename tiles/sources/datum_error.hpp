// How far off a source lies because of the datum of its reference system.
#pragma once

#include <ogr_spatialref.h>

#include <string>

#include "core/geodesy/utm.hpp"

namespace roadfix {

struct PositionError {
  double sigma_m = 0.0;  ///< of each axis; 0 where nothing tells
  std::string reason;    ///< for the user to read, with what to do about it
};

/// Of the datum of a reference system on_old_ellipsoid() around a place: what the EPSG registry states for the best way
/// to WGS 84 that can be taken there, if that is more than 2 m. 0 for reference systems that bring a way of their own,
/// and where the registry states nothing. Throws InvalidInput "datum-unknown", which names `path`, where nobody has
/// published any way around there.
PositionError datum_error(const OGRSpatialReference& reference, UtmZone zone, LatLon place, const std::string& path);

}  // namespace roadfix
