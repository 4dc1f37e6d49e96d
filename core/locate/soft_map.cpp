#include "core/locate/soft_map.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/grid/resample.hpp"
#include "core/match/soft_cells.hpp"
#include "core/units/floor_div.hpp"

namespace roadfix {
namespace {

const SoftCells& half_the_log_odds() {
  static const SoftCells kSoft(0.5);
  return kSoft;
}

CellArray soft_cells(const GridReader& read, const GridGeometry& geometry) {
  CellArray cells = read(geometry).cells;
  half_the_log_odds().apply(cells);
  return cells;
}

constexpr int kKeptBlockCells = 128;  // side of the blocks of coarser cells that are made and kept
constexpr std::size_t kBytesOfOneSearch = std::size_t{64} << 20;

// Coarser cells are made from cells two levels finer: roads are hardly narrower than a quarter of the coarsest ones.
constexpr int kFinerLevels = 2;

struct SoftBlock {
  CellArray cells;
  std::size_t bytes() const { return cells.cells().size(); }
};

SoftBlock soft_block(const GridReader& read, const GridGeometry& window, int levels) {
  GridGeometry fine = window;
  for (int k = 0; k < levels; ++k) {
    fine = {0.5 * fine.cell_m, {2 * fine.origin.col, 2 * fine.origin.row}, 2 * fine.cols, 2 * fine.rows};
  }
  SoftBlock block{soft_cells(read, fine)};
  for (int k = 0; k < levels; ++k) block.cells = halved(block.cells);
  return block;
}

}  // namespace

GridReader soft_reader(const MapView& map, double finest_cell_m) {
  const auto kept = map.searches ? map.searches : std::make_shared<SearchCache>(kBytesOfOneSearch);
  return [read = map.read, kept, finest_cell_m](const GridGeometry& geometry) {
    const int levels =
        std::min(kFinerLevels, static_cast<int>(std::lround(std::log2(geometry.cell_m / finest_cell_m))));
    if (levels <= 0) return RoadGrid{geometry, soft_cells(read, geometry)};
    RoadGrid grid{geometry, CellArray(geometry.cols, geometry.rows)};
    const auto block_of = [](int cell) { return floor_div(cell, kKeptBlockCells); };
    const LatticeIndex first = geometry.origin;
    for (int row = block_of(first.row); row * kKeptBlockCells < first.row + geometry.rows; ++row) {
      for (int col = block_of(first.col); col * kKeptBlockCells < first.col + geometry.cols; ++col) {
        const GridGeometry window{
            geometry.cell_m, {col * kKeptBlockCells, row * kKeptBlockCells}, kKeptBlockCells, kKeptBlockCells};
        const auto block = kept->get<SoftBlock>(window, {levels}, {}, [&] { return soft_block(read, window, levels); });
        paste(block->cells, grid.cells, window.origin.col - first.col, window.origin.row - first.row);
      }
    }
    return grid;
  };
}

MapView soft_view(const MapView& map) {
  MapView result = map;
  result.searches = nullptr;
  result.read = [read = map.read](const GridGeometry& geometry) {
    return RoadGrid{geometry, soft_cells(read, geometry)};
  };
  return result;
}

FeatureMap softened(FeatureMap features) {
  half_the_log_odds().apply(features.cells);
  return features;
}

}  // namespace roadfix
