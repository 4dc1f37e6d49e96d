// A map of a town, a feature map seen in it, and `roadfix` run on both as a script does.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "core/detect/feature_map_codec.hpp"
#include "core/geodesy/utm.hpp"
#include "core/grid/terrain.hpp"
#include "tests/support/map_file.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/street_map.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tiles/store/map_writer.hpp"

namespace roadfix::testing {

class LocalizeCommands : public ::testing::Test {
 protected:
  LocalizeCommands() {
    write_map_file(map, town, 0.0);
    save_what_is_seen(truth, 160, window);
  }

  FeatureMap what_is_seen(const GridPose& pose, int side) const {
    std::mt19937_64 random(42);
    return observed_at(town, pose, side, side, 2.0, {0.1, 0.1}, random);
  }

  static void save(const std::vector<std::uint8_t>& png, const std::filesystem::path& file) {
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
  }

  void save_what_is_seen(const GridPose& pose, int side, const std::filesystem::path& file) const {
    save(encode_feature_map(what_is_seen(pose, side).cells), file);
  }

  void lay_level_ground(double height_m) const {
    Terrain level = Terrain::unknown(GridGeometry::covering(town.geometry.box(), Terrain::kFinestCellM).padded(40));
    for (std::uint16_t& code : level.codes) code = Terrain::code_of(height_m);
    MapWriter(map, {zone, town.geometry.cell_m}).put_terrain(level, {.location = "dem.tif"});
  }

  ProgramResult roadfix(const std::string& arguments) const { return run_program(folder.path(), arguments); }

  std::string at(const LatLon& p) const {
    return "--lat " + std::to_string(p.lat_deg) + " --lon " + std::to_string(p.lon_deg);
  }

  UtmZone zone = UtmZone::from_epsg(32634).value();
  RoadGrid town = street_map(41, {2.0, {300'100, -3'200'050}, 500, 450});
  GridPose truth{{600'700.0, 6'399'600.0}, Angle::degrees(217.0)};
  LatLon place = zone.unproject(truth.position);
  double heading_deg = zone.true_from_grid(truth.heading, truth.position).compass_degrees();
  TemporaryFolder folder;
  std::filesystem::path map = folder / "town.gpkg";
  std::filesystem::path window = folder / "window.png";
  std::string input = map.string() + " " + window.string() + " --cell 2 ";
};

}  // namespace roadfix::testing
