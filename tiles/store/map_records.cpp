#include "tiles/store/map_records.hpp"

#include <algorithm>
#include <cassert>

#include "core/units/floor_div.hpp"

namespace roadfix {

GridGeometry tile_geometry(TileIndex tile, double cell_m) {
  return {cell_m, {tile.col * kTileCells, tile.row * kTileCells}, kTileCells, kTileCells};
}

std::vector<TileIndex> tiles_covering(const GridGeometry& geometry) {
  assert(geometry.cols >= 0 && geometry.rows >= 0);
  std::vector<TileIndex> tiles;
  if (geometry.cols == 0 || geometry.rows == 0) return tiles;
  const auto [west, north] = geometry.origin;
  const int first_col = floor_div(west, kTileCells);
  const int last_col = floor_div(west + geometry.cols - 1, kTileCells);
  const int last_row = floor_div(north + geometry.rows - 1, kTileCells);
  for (int row = floor_div(north, kTileCells); row <= last_row; ++row) {
    for (int col = first_col; col <= last_col; ++col) tiles.push_back({col, row});
  }
  return tiles;
}

std::string credits_of(const MapInfo& info) {
  std::vector<std::string> credits;
  for (const SourceStatus& source : info.sources) {
    const std::string& attribution = source.record.attribution;
    const std::string& licence = source.record.licence;
    if (!source.complete || (attribution.empty() && licence.empty())) continue;
    const std::string credit =
        attribution.empty() || licence.empty() ? attribution + licence : attribution + " (" + licence + ")";
    if (std::ranges::find(credits, credit) == credits.end()) credits.push_back(credit);
  }
  std::string text;
  for (const std::string& credit : credits) text += (text.empty() ? "" : "; ") + credit;
  return text;
}

}  // namespace roadfix
