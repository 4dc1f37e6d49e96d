#include "tiles/store/tile_matrix.hpp"

#include <gmock/gmock.h>

#include <set>

#include "core/grid/lattice.hpp"
#include "tests/tiles/store/map_fixture.hpp"

namespace roadfix {
namespace {

TEST(TileMatrix, ZoomLevelsHalveTheCellAndFillTheLattice) {
  for (int zoom = 0; zoom <= 14; ++zoom) {
    EXPECT_EQ(zoom_of(cell_of_zoom(zoom)), zoom);
    EXPECT_EQ(matrix_width(zoom) * kTileCells * cell_of_zoom(zoom), kLattice.max.east_m);
    EXPECT_EQ(matrix_height(zoom) * kTileCells * cell_of_zoom(zoom), kLattice.max.north_m);
  }
  EXPECT_EQ(zoom_of(kMinCellM), 14);
  EXPECT_EQ(zoom_of(kMaxCellM), 8);
}

TEST(TileMatrix, RowsAreCountedFromTheNorthernEdge) {
  const int zoom = 11;
  EXPECT_EQ(tile_row({0, -matrix_height(zoom)}, zoom), 0);
  EXPECT_EQ(tile_row({0, -1}, zoom), matrix_height(zoom) - 1);
  EXPECT_EQ(tile_geometry({0, -matrix_height(zoom)}, 2.0).box().max.north_m, kLattice.max.north_m);
  EXPECT_EQ(index_row(tile_row({3, -77}, zoom), zoom), -77);
}

TEST(TileMatrix, TheLatticeEndsWhereItEnds) {
  EXPECT_TRUE(on_lattice({0, -1}, 4));
  EXPECT_TRUE(on_lattice({15, -160}, 4));
  for (const TileIndex outside : {TileIndex{-1, -1}, {16, -1}, {0, 0}, {0, -161}}) EXPECT_FALSE(on_lattice(outside, 4));
}

TEST(TileMatrix, TheHashFeelsEveryByteAndThePlace) {
  std::vector<std::byte> png(21);
  std::set<std::uint64_t> hashes{content_hash({1, 2}, png), content_hash({2, 1}, png), content_hash({1, 2}, {})};
  for (std::byte& byte : png) {
    byte = std::byte{1};
    hashes.insert(content_hash({1, 2}, png));
    byte = std::byte{0};
  }
  EXPECT_EQ(hashes.size(), 3 + png.size());
}

TEST(TilesCovering, AreAllTilesThatHoldACellOfTheGrid) {
  for (const LatticeIndex origin : {LatticeIndex{0, 0}, {-1, -1}, {255, -257}, {-700, 300}}) {
    for (const int size : {0, 1, 2, 256, 257, 600}) {
      std::set<TileIndex> expected;
      for (int row = -4; row < 4; ++row) {
        for (int col = -4; col < 4; ++col) {
          if (tile_geometry({col, row}, 1.0).intersection({1.0, origin, size, size})) expected.insert({col, row});
        }
      }
      const auto tiles = tiles_covering({1.0, origin, size, size});
      EXPECT_EQ(std::set<TileIndex>(tiles.begin(), tiles.end()), expected);
      EXPECT_EQ(tiles.size(), expected.size());
    }
  }
}

}  // namespace
}  // namespace roadfix
