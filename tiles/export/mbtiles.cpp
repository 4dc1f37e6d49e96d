#include "tiles/export/mbtiles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <vector>

#include "core/units/error.hpp"
#include "tiles/sources/exported_roads.hpp"
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

void complete_metadata(const std::filesystem::path& tiles, const MapInfo& info) {
  sqlite::Connection connection(tiles, sqlite::Access::kReadWrite, error_of);
  connection.execute("UPDATE metadata SET value = (SELECT min(zoom_level) FROM tiles) WHERE name = 'minzoom'");
  auto items = provenance_items(provenance_of(info));
  if (const std::string credits = credits_of(info); !credits.empty()) items.emplace_back("attribution", credits);
  sqlite::Statement insert(connection, "INSERT INTO metadata (name, value) VALUES (?1, ?2)");
  for (const auto& [name, value] : items) insert.with(name, value).run();
}

}  // namespace roadfix
