// A map file with bytes changed or cut off: reading and verifying it ends in an answer or in an error of ours. The
// input is a list of changes to a small map: three bytes of offset and one of value each; offset 0xffffff cuts the file
// there.
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "core/units/error.hpp"
#include "tests/support/put_block.hpp"
#include "tiles/store/map_reader.hpp"
#include "tiles/store/map_verifier.hpp"
#include "tiles/store/map_writer.hpp"

namespace roadfix {
namespace {

namespace fs = std::filesystem;

fs::path scratch() {
  return fs::temp_directory_path() / ("roadfix-map-file-fuzz-" + std::to_string(getpid()) + ".gpkg");
}

std::string small_map() {
  const fs::path path = scratch();
  fs::remove(path);
  {
    MapWriter writer(path, {*UtmZone::from_epsg(32637), 16.0});
    const TileIndex block{100, -1000};
    const SourceRecord source{
        .name = "a", .content = SourceContent::kRoads, .fingerprint = "1", .provenance = {.registration_sigma_m = 1.0}};
    writer.begin_source(source, {&block, 1}, false);
    testing::put_block(writer, "a", block, CellArray(kTileCells, kTileCells, kRoad));
    writer.finish_source("a");
    Terrain terrain = Terrain::unknown({32.0, {6400, -64'000}, 300, 300});
    terrain.codes.front() = terrain.codes.back() = Terrain::code_of(500.0);
    writer.put_terrain(terrain, {.location = "heights.tif"});
  }
  std::stringstream bytes;
  bytes << std::ifstream(path, std::ios::binary).rdbuf();
  return bytes.str();
}

std::string changed(std::string map, const std::uint8_t* data, std::size_t size) {
  for (; size >= 4; data += 4, size -= 4) {
    const std::size_t offset = std::size_t{data[0]} << 16 | std::size_t{data[1]} << 8 | data[2];
    if (offset == 0xffffff) {
      map.resize(map.size() * data[3] / 256);
    } else if (!map.empty()) {
      map[offset % map.size()] = static_cast<char>(data[3]);
    }
  }
  return map;
}

void read_everything(const fs::path& path) {
  const MapReader map(path);
  for (int level = 0; level < map.info().levels; ++level) {
    for (const TileIndex tile : map.tiles(level)) map.tile(level, tile);
  }
  map.read({map.info().settings.cell_m, {100 * 256, -1000 * 256}, 300, 300});
}

void try_every_use(const std::uint8_t* data, std::size_t size) {
  static const std::string whole = small_map();
  const fs::path path = scratch();
  std::ofstream(path, std::ios::binary | std::ios::trunc) << changed(whole, data, size);
  for (const auto& use :
       {+[](const fs::path& file) { read_everything(file); }, +[](const fs::path& file) { verify_map(file); }}) {
    try {
      use(path);
    } catch (const Error&) {
      continue;
    }
  }
  std::error_code ignored;
  fs::remove(path, ignored);
}

}  // namespace
}  // namespace roadfix

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  roadfix::try_every_use(data, size);
  return 0;
}
