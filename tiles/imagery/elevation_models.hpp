// Elevation models as the heights of the ground of a zone: rasters of one band, in any reference system and unit, whose
// heights are above the sea (by a geoid), as those of Copernicus DEM or SRTM are.
#pragma once

#include <cstdint>
#include <stop_token>
#include <string>
#include <vector>

#include "core/geodesy/utm.hpp"
#include "core/grid/terrain.hpp"
#include "core/units/planar.hpp"
#include "core/units/progress.hpp"

namespace roadfix {

/// Cells for the heights of this ground and of what a vehicle may fly over beside it (2 km), as far as the lattice
/// goes: the finest of which there are at most `most_cells`.
GridGeometry terrain_geometry(const GridBox& ground, std::int64_t most_cells);

struct ElevationReading {
  Terrain terrain;
  std::vector<std::string> beside;  ///< models that know no height of these cells
};

/// Mean heights of the cells, of which at least half has to be known: of the finer model where both know, and of both
/// where they meet. Throws what RasterFile and Georeference throw, InvalidInput ("elevation-not-heights",
/// "elevation-above-ellipsoid", "elevation-unit-unknown", "elevation-impossible", "elevation-beyond-map" where no model
/// knows any height) and Interrupted ("work-stopped").
ElevationReading read_elevation_models(const std::vector<std::string>& paths, UtmZone zone,
                                       const GridGeometry& geometry, const OnProgress& progress = {},
                                       std::stop_token stop = {});

}  // namespace roadfix
