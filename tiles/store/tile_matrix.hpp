// The pyramid of a map file: one fixed lattice for every map of a zone (OGC tile matrix set), so that tile indices are
// shared and maps grow without renumbering.
//
// It covers kLattice (core/grid/lattice.hpp): zoom level z has cells of 2^(12 - z) m and 2^z x 10 * 2^z tiles of 256 x
// 256 cells. The file counts tile rows from the northern edge of the lattice, TileIndex from north = 0: tile_row =
// TileIndex::row + 10 * 2^z.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "tiles/store/map_records.hpp"

namespace roadfix {

/// Overviews go up to cells of 256 m, tiles of 65 km: a handful of tiles for any map.
inline constexpr int kCoarsestZoom = 4;

/// Cell size must be a power of two, at most 4096 m.
int zoom_of(double cell_m);
constexpr double cell_of_zoom(int zoom) { return 4096.0 / static_cast<double>(1 << zoom); }
constexpr int matrix_width(int zoom) { return 1 << zoom; }
constexpr int matrix_height(int zoom) { return 10 << zoom; }
constexpr int tile_row(TileIndex tile, int zoom) { return tile.row + matrix_height(zoom); }
constexpr int index_row(int tile_row, int zoom) { return tile_row - matrix_height(zoom); }

constexpr bool on_lattice(TileIndex tile, int zoom) {
  return tile.col >= 0 && tile.col < matrix_width(zoom) && tile.row < 0 && tile.row >= -matrix_height(zoom);
}

/// Whether a row of one of the file's tables is a tile of the level.
constexpr bool in_matrix(int zoom, std::int64_t tile_row, std::int64_t tile_column) {
  return tile_row >= 0 && tile_row < matrix_height(zoom) && tile_column >= 0 && tile_column < matrix_width(zoom);
}

/// Whether it is one of the pyramid that ends with `finest_zoom`.
constexpr bool in_pyramid(std::int64_t zoom, std::int64_t tile_row, std::int64_t tile_column, int finest_zoom) {
  return zoom >= kCoarsestZoom && zoom <= finest_zoom && in_matrix(static_cast<int>(zoom), tile_row, tile_column);
}

/// Contribution of one tile to the version of a map: the sum over the finest tiles does not depend on their order.
std::uint64_t content_hash(TileIndex tile, std::span<const std::byte> png);

}  // namespace roadfix
