#include "tiles/store/map_records.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <map>
#include <string>
#include <vector>

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

namespace {

std::vector<Provenance> parts_of(const MapInfo& info) {
  std::vector<Provenance> parts;
  for (const SourceStatus& source : info.sources) {
    if (!source.complete) continue;
    parts.push_back(source.record.provenance);
    parts.back().registration_sigma_m = source.registration_sigma_m();
  }
  return parts;
}

}  // namespace

std::vector<SourceRecord> records_of(const MapInfo& info, const std::string& source) {
  std::vector<SourceRecord> records;
  for (const SourceStatus& status : info.sources) {
    if (status.record.name == source) records.push_back(status.record);
  }
  return records;
}

std::string missing_of(const MapInfo& info) {
  std::string text;
  for (const SourceStatus& source : info.sources) {
    if (source.complete) continue;
    text += fmt::format("{}source '{}': {} of {} blocks", text.empty() ? "" : "; ", source.record.name,
                        source.blocks_done, source.blocks_total);
  }
  return text;
}

Provenance provenance_of(const MapInfo& info) { return combined(parts_of(info)); }

std::string credits_of(const MapInfo& info) { return credits_of(parts_of(info)); }

std::optional<std::string> imagery_reader_of(const MapInfo& info) {
  std::int64_t of_roads = 0;
  std::map<std::string, std::int64_t> of_readers;
  for (const SourceStatus& source : info.sources) {
    if (!source.complete) continue;
    const bool imagery = source.record.content == SourceContent::kImagery;
    const std::string reader(detector_in(source.record.method));
    (imagery ? of_readers[reader] : of_roads) += source.blocks_total;
  }
  const auto most = std::ranges::max_element(of_readers, {}, [](const auto& reader) { return reader.second; });
  return most != of_readers.end() && most->second >= of_roads ? std::optional(most->first) : std::nullopt;
}

bool shows_imagery_and_roads(const MapInfo& info) {
  const auto has = [&](SourceContent content) {
    return std::ranges::any_of(
        info.sources, [&](const SourceStatus& source) { return source.complete && source.record.content == content; });
  };
  return has(SourceContent::kImagery) && has(SourceContent::kRoads);
}

}  // namespace roadfix
