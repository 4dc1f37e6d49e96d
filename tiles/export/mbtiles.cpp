#include "tiles/export/mbtiles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <vector>

#include "core/units/error.hpp"
#include "tiles/store/map_records.hpp"
#include "tiles/store/sqlite.hpp"

namespace roadfix {
namespace {

std::exception_ptr error_of(const std::filesystem::path& file, sqlite::Failure, const std::string& detail) {
  return std::make_exception_ptr(
      IoFailure("export-failed",
                fmt::format("{}: it cannot be written ({}). Check that the disk has room", file.string(), detail)));
}

}  // namespace

bool add_zooms(GDALDataset& tiles, GDALProgressFunc progress, void* monitor) {
  const int pixels = std::max(tiles.GetRasterXSize(), tiles.GetRasterYSize());
  std::vector<int> factors;
  for (int factor = 2; pixels > factor / 2 * kTileCells; factor *= 2) factors.push_back(factor);
  if (factors.empty()) return true;
  return tiles.BuildOverviews("AVERAGE", static_cast<int>(factors.size()), factors.data(), 0, nullptr, progress,
                              monitor, nullptr) == CE_None;
}

void complete_metadata(const std::filesystem::path& tiles, const std::string& attribution) {
  sqlite::Connection connection(tiles, sqlite::Access::kReadWrite, error_of);
  connection.execute("UPDATE metadata SET value = (SELECT min(zoom_level) FROM tiles) WHERE name = 'minzoom'");
  if (attribution.empty()) return;
  sqlite::Statement(connection, "INSERT INTO metadata (name, value) VALUES ('attribution', ?1)")
      .with(attribution)
      .run();
}

}  // namespace roadfix
