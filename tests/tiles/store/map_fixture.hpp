// Small maps for the tests of the store: sources drawn from a seed, and a map as the set of its tiles.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "tests/support/put_block.hpp"
#include "tests/support/sqlite_file.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tiles/store/map_reader.hpp"
#include "tiles/store/map_writer.hpp"

namespace roadfix::testing {

inline MapSettings settings_37n(double cell_m = 2.0) { return {*UtmZone::from_epsg(32637), cell_m}; }

/// Blocks around Adiyaman (about 434 km east, 4180 km north), `size` x `size` of them.
inline std::vector<TileIndex> some_blocks(int size, int shift = 0) {
  std::vector<TileIndex> blocks;
  for (int row = 0; row < size; ++row) {
    for (int col = 0; col < size; ++col) blocks.push_back({847 + col + shift, -8165 + row + shift});
  }
  return blocks;
}

/// Random cells in runs, of which about a third is unobserved; the same for the same seed and block.
inline CellArray random_cells(std::uint64_t seed, TileIndex block) {
  std::mt19937_64 random(seed * 1'000'003 + static_cast<std::uint64_t>(block.col * 7919 - block.row));
  CellArray cells(kTileCells, kTileCells);
  const auto all = cells.cells();
  for (std::size_t i = 0; i < all.size();) {
    const auto draw = random();
    const std::size_t run = std::min<std::size_t>(1 + draw % 64, all.size() - i);
    const auto value = (draw >> 8) % 384;
    std::ranges::fill(all.subspan(i, run), value < 255 ? static_cast<Cell>(value) : kUnobserved);
    i += run;
  }
  return cells;
}

struct TestSource {
  std::string name;
  std::uint64_t seed = 1;
  std::vector<TileIndex> blocks;
  SourceRecord record() const {
    return {.name = name,
            .content = SourceContent::kImagery,
            .location = name + ".tif",
            .fingerprint = name + std::to_string(seed),
            .method = "tree",
            .provenance = {
                .date = "2023-02-06", .licence = "CC BY 4.0", .attribution = "someone", .registration_sigma_m = 2.5}};
  }
};

inline void ingest(MapWriter& writer, const TestSource& source, bool replace = false) {
  for (const TileIndex block : writer.begin_source(source.record(), source.blocks, replace)) {
    put_block(writer, source.name, block, random_cells(source.seed, block));
  }
  writer.finish_source(source.name);
}

using TileBytes = std::map<std::tuple<std::int64_t, std::int64_t, std::int64_t>, std::string>;

/// Every tile of the fused map, byte for byte.
inline TileBytes tile_bytes(const std::filesystem::path& path) {
  sqlite::Connection map = open_sqlite(path, sqlite::Access::kRead);
  sqlite::Statement select(map, "SELECT zoom_level, tile_column, tile_row, tile_data FROM road_probability");
  TileBytes tiles;
  while (select.step()) {
    const auto blob = select.blob(3);
    tiles[{select.integer(0), select.integer(1), select.integer(2)}] =
        std::string(reinterpret_cast<const char*>(blob.data()), blob.size());
  }
  return tiles;
}

}  // namespace roadfix::testing
