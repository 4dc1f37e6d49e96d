// Roads around a place in UTM 37 north, in files as users have them.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "tests/support/temporary_folder.hpp"
#include "tests/tiles/sources/place.hpp"
#include "tiles/roads/road_lines.hpp"

namespace roadfix::testing {

inline std::string degrees(GridPoint p) {
  const LatLon place = kZone.unproject(p);
  return fmt::format("[{:.9f},{:.9f}]", place.lon_deg, place.lat_deg);
}

inline std::string feature(const std::string& properties, GridPoint from, GridPoint to) {
  return fmt::format(
      R"({{"type":"Feature","properties":{{{}}},"geometry":{{"type":"LineString","coordinates":[{},{}]}}}})",
      properties, degrees(from), degrees(to));
}

inline GridPoint at(double east, double north) { return {kCentre.east_m + east, kCentre.north_m + north}; }

inline std::string extent_around_centre(double half_m) {
  const LatLon low = kZone.unproject(at(-half_m, -half_m));
  const LatLon high = kZone.unproject(at(half_m, half_m));
  return fmt::format("{},{},{},{}", low.lon_deg, low.lat_deg, high.lon_deg, high.lat_deg);
}

class RoadFeatures : public ::testing::Test {
 protected:
  /// A street of 141 m to the north-east, from there.
  static std::string road(double east, double north) {
    return feature(R"("highway":"residential")", at(east, north), at(east + 100, north + 100));
  }
  /// What reading the roads has to say of them.
  std::vector<std::string> notes(const std::vector<std::string>& roads, const std::string& extent = "") {
    return read_road_network({geojson(roads)}, {.crs = "", .layer = "", .extent = extent}, RoadRules(), kZone).notes;
  }
  /// `members` of the collection stand before its features, each with its comma.
  std::string geojson(const std::vector<std::string>& features, const std::string& members = "") {
    std::ofstream file(folder / "roads.geojson");
    file << R"({"type":"FeatureCollection",)" << members << R"("features":[)";
    for (std::size_t i = 0; i < features.size(); ++i) file << (i > 0 ? "," : "") << features[i];
    file << "]}";
    return (folder / "roads.geojson").string();
  }
  TemporaryFolder folder;
};

}  // namespace roadfix::testing
