// What the tests of exports share.
#pragma once

#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/code_of.hpp"
#include "tests/tiles/store/map_fixture.hpp"
#include "tiles/export/map_export.hpp"

namespace roadfix::testing {

/// A map whose blocks hold one value each.
inline void ingest_plain(const std::filesystem::path& path, const MapSettings& settings,
                         const std::vector<std::pair<TileIndex, Cell>>& of) {
  MapWriter writer(path, settings);
  std::vector<TileIndex> blocks;
  for (const auto& [block, value] : of) blocks.push_back(block);
  const auto record = TestSource{"a", 1, blocks}.record();
  writer.begin_source(record, blocks, false);
  for (const auto& [block, value] : of) {
    put_block(writer, "a", block, CellArray(kTileCells, kTileCells, value));
  }
  writer.finish_source("a");
}

class MapExport : public ::testing::Test {
 protected:
  MapExport() : path(folder / "m.gpkg") {
    MapWriter writer(path, settings_37n());
    ingest(writer, {"a", 1, some_blocks(2)});
    GDALAllRegister();
  }

  std::string code_of(const std::filesystem::path& target, const ExportOptions& options,
                      std::stop_token stop = {}) const {
    return testing::code_of([&] { export_map(MapReader(path), target, options, {}, stop); });
  }

  std::size_t files() const {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(folder.path()), std::filesystem::directory_iterator()));
  }

  TemporaryFolder folder;
  std::filesystem::path path;
};

}  // namespace roadfix::testing
