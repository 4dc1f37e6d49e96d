#include "server/api/geojson.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <vector>

namespace roadfix::api {
namespace {

using nlohmann::json;

TEST(GeoJson, OfOneSideIsWhole) {
  EXPECT_EQ(line_json(std::vector<LatLon>{{-16, 179}, {-16, 179}, {-17, 180}}),
            json::parse(R"({"type": "LineString", "coordinates": [[179, -16], [179, -16], [180, -17]]})"));
  EXPECT_EQ(polygon_json(std::vector<LatLon>{{1, -1}, {0, -1}, {0, 1}, {1, -1}}),
            json::parse(R"({"type": "Polygon", "coordinates": [[[-1, 1], [-1, 0], [1, 0], [-1, 1]]]})"));
}

TEST(GeoJson, LinesAreCutWhereverTheyCross180Degrees) {
  EXPECT_EQ(line_json(std::vector<LatLon>{{-16, 179}, {-20, -177}, {-20, -178}, {-16, 178}}),
            json::parse(R"({"type": "MultiLineString", "coordinates": [
                [[179, -16], [180, -17]], [[-180, -17], [-177, -20], [-178, -20], [-180, -18]], [[180, -18], [178, -16]]]})"));
}

TEST(GeoJson, APlaceAt180DegreesIsOfEitherSide) {
  EXPECT_EQ(
      line_json(std::vector<LatLon>{{0, 179}, {1, 180}, {2, -179}}),
      json::parse(R"({"type": "MultiLineString", "coordinates": [[[179, 0], [180, 1]], [[-180, 1], [-179, 2]]]})"));
  EXPECT_EQ(line_json(std::vector<LatLon>{{0, 179}, {1, -180}, {0, 178}}),
            json::parse(R"({"type": "MultiLineString", "coordinates": [[[179, 0], [180, 1]], [[180, 1], [178, 0]]]})"));
}

TEST(GeoJson, RingsAreTheirPartsOnEitherSideWhereverTheyBegin) {
  const std::vector<LatLon> corners{{0, 179}, {0, -179}, {2, -179}, {2, 179}};
  for (std::size_t first = 0; first < corners.size(); ++first) {
    std::vector<LatLon> ring;
    for (std::size_t i = 0; i <= corners.size(); ++i) ring.push_back(corners[(first + i) % corners.size()]);
    const json polygon = polygon_json(ring);
    EXPECT_EQ(polygon["type"], "MultiPolygon");
    ASSERT_EQ(polygon["coordinates"].size(), 2U) << polygon;
    for (const json& part : polygon["coordinates"]) {
      const json& places = part.at(0);
      ASSERT_EQ(places.size(), 5U) << polygon;
      EXPECT_EQ(places.front(), places.back());
      double twice_area = 0.0;  // against the clock, as it came
      for (std::size_t i = 0; i + 1 < places.size(); ++i) {
        const auto at = [&](std::size_t corner, std::size_t axis) { return places[corner][axis].get<double>(); };
        twice_area += at(i, 0) * at(i + 1, 1) - at(i + 1, 0) * at(i, 1);
      }
      EXPECT_EQ(twice_area, 4.0) << polygon;
    }
  }
}

TEST(GeoJson, ARingThatTouches180DegreesIsWhole) {
  const json polygon = polygon_json(std::vector<LatLon>{{0, 179}, {1, -180}, {2, 179}, {0, 179}});
  EXPECT_EQ(polygon["type"], "Polygon") << polygon;
  EXPECT_EQ(polygon["coordinates"][0].size(), 4U) << polygon;
}

}  // namespace
}  // namespace roadfix::api
