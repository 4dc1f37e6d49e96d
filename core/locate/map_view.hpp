// The port through which localization asks for the global map. tiles/view reads a file, tests draw ASCII:
// the caller composes it, so core knows no storage.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/geodesy/utm.hpp"
#include "core/grid/road_grid.hpp"
#include "core/grid/terrain.hpp"
#include "core/locate/map_id.hpp"
#include "core/search/search_cache.hpp"

namespace roadfix {

struct MapView {
  MapId id;
  UtmZone zone;
  double cell_m = 2.0;
  GridBox extent;  ///< box of the observed cells
  /// RoadDetector::describe() of what read most of the map's ground in imagery; nullopt where more of it, or all, is
  /// road data. Frames that are compared with the map are best read by the same (Detectors).
  std::optional<std::string> imagery_reader = {};
  /// Position error (1 sigma per axis) of the least exact of the sources that observed the ground around a place;
  /// beyond them all, of all. Safe to call from several threads.
  std::function<double(GridPoint place)> registration_sigma_m;
  /// Cells of the geometry, unobserved where the map has none. `geometry.cell_m` is cell_m * 2^k.
  /// Safe to call from several threads.
  std::function<RoadGrid(const GridGeometry& geometry)> read;
  /// What searches build of this version of the map, as soft_reader() gives it; nullptr = nothing is kept.
  std::shared_ptr<SearchCache> searches = nullptr;
  /// Some of it is imagery and some road data, so that `imagery_reader` suits a part of the ground only.
  bool imagery_and_roads = false;
  /// Heights of its ground; nullptr = the map has none.
  std::shared_ptr<const Terrain> terrain = nullptr;
};

}  // namespace roadfix
