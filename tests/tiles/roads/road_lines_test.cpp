#include "tiles/roads/road_lines.hpp"

#include <cpl_conv.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "tests/support/code_of.hpp"
#include "tests/tiles/roads/road_features.hpp"
#include "tiles/roads/vector_roads.hpp"
#include "tiles/sources/gdal_session.hpp"
#include "tiles/sources/temporary_files.hpp"

namespace roadfix {
namespace {

using ::testing::AllOf;
using testing::at;
using testing::code_of;
using ::testing::Contains;
using testing::degrees;
using ::testing::ElementsAre;
using testing::feature;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::kCentre;
using testing::kZone;
using testing::message_of;
using ::testing::Not;

using RoadLines = testing::RoadFeatures;

TEST_F(RoadLines, OpenStreetMapXmlIsReadWithAllItsTags) {
  std::ofstream file(folder / "a.osm");
  file << "<?xml version='1.0'?><osm version='0.6'>";
  const auto node = [&](int id, GridPoint p) {
    const LatLon place = kZone.unproject(p);
    file << fmt::format("<node id='{}' version='1' lat='{:.8f}' lon='{:.8f}'/>", id, place.lat_deg, place.lon_deg);
  };
  for (int i = 0; i < 3; ++i) {
    node(2 * i + 1, at(-150, 60.0 * i - 60));
    node(2 * i + 2, at(150, 60.0 * i - 60));
  }
  const auto way = [&](int id, const std::string& tags) {
    file << fmt::format(
        "<way id='{}' version='1'><nd ref='{}'/><nd ref='{}'/><tag k='highway' v='residential'/>{}</way>", id,
        2 * id - 1, 2 * id, tags);
  };
  way(1, "");
  way(2, "<tag k='tunnel' v='yes'/>");
  way(3, "<tag k='width' v='12'/>");
  file << "</osm>";
  file.close();
  const RoadNetwork network = read_road_network({(folder / "a.osm").string()}, {}, RoadRules(), kZone);
  ASSERT_EQ(network.lines.size(), 2U);
  EXPECT_EQ(network.left_out, 1);
  EXPECT_EQ(network.lines[0].half_width_m, 3.0);
  EXPECT_EQ(network.lines[1].half_width_m, 6.0);
  EXPECT_NEAR(network.points[0].east_m, kCentre.east_m - 150.0, 0.01);
}

TEST_F(RoadLines, OfOpenStreetMapAreToldApartByAnyTagHoweverManyNodesWithTagsComeBeforeThem) {
  const std::string path = (folder / "trees.osm").string();
  {
    std::ofstream file(path);
    file << "<?xml version='1.0'?><osm version='0.6'>";
    for (int i = 1; i <= 20000; ++i) {
      file << fmt::format("<node id='{}' version='1' lat='37.{:05}' lon='38'><tag k='natural' v='tree'/></node>", i, i);
    }
    file << "<way id='1' version='1'><nd ref='1'/><nd ref='99'/><tag k='tracktype' v='grade1'/></way>"
            "<way id='2' version='1'><nd ref='2'/><nd ref='98'/><tag k='waterway' v='river'/></way></osm>";
  }
  RoadRules rules = RoadRules::parse("grade1 4 yes");
  rules.set_class_attribute("tracktype");
  const RoadNetwork network = read_road_network({path}, {}, rules, kZone);
  EXPECT_EQ(network.lines.size(), 1U);
  EXPECT_EQ(network.left_out, 1);
  EXPECT_THAT(network.notes, IsEmpty());
}

TEST_F(RoadLines, OfOpenStreetMapBeyondMemoryAskForRoomAndAreNotCalledDamaged) {
  const std::string path = (folder / "large.osm").string();
  {
    std::ofstream file(path);
    file << "<?xml version='1.0'?><osm version='0.6'>";
    for (int i = 1; i <= 4000; ++i) {  // far apart, each takes half a kilobyte
      file << fmt::format("<node id='{}' version='1' lat='37.7' lon='38.{:04}'/>", 64 * i, i);
    }
    file << "<way id='1' version='1'><nd ref='64'/><nd ref='128'/><tag k='highway' v='primary'/></way></osm>";
  }
  require_gdal();
  const auto read = [&](const std::string& temporary) {
    keep_temporary_files_beside(temporary + "/m.gpkg");
    std::string code = code_of([&] { read_road_network({path}, {}, RoadRules(), kZone); });
    CPLSetConfigOption("CPL_TMPDIR", nullptr);
    return code;
  };
  const char* const asked = CPLGetConfigOption("TMPDIR", CPLGetConfigOption("TEMP", nullptr));
  if (asked != nullptr) GTEST_SKIP() << "the environment says where temporary files are";
  CPLSetConfigOption("OSM_MAX_TMPFILE_SIZE", "1");
  EXPECT_EQ(read((folder / "not there").string()), "temporary-files-refused");
  EXPECT_EQ(read(folder.path().string()), "no error");
  CPLSetConfigOption("OSM_MAX_TMPFILE_SIZE", nullptr);
}

TEST_F(RoadLines, RiversBesideClassifiedRoadsAreNotDrawnAndSaidSo) {
  const std::string roads = geojson({feature(R"("highway":"primary")", at(-150, 40), at(150, 40))});
  std::filesystem::rename(roads, folder / "streets.geojson");
  const std::string streets = (folder / "streets.geojson").string();
  const std::string rivers = geojson({feature(R"("name":"Firat")", at(-190, -90), at(190, -40))});
  for (const auto& paths : {std::vector{streets, rivers}, std::vector{rivers, streets}}) {
    const RoadNetwork network = read_road_network(paths, {}, RoadRules(), kZone);
    ASSERT_EQ(network.lines.size(), 1U);
    EXPECT_EQ(network.lines.front().half_width_m, 5.0);
    EXPECT_EQ(network.left_out, 1);
    EXPECT_EQ(network.covered.size(), 1U) << "where a river is known, a road need not be";
    EXPECT_THAT(network.notes, ElementsAre(AllOf(HasSubstr("layer 'roads'"), HasSubstr("none of its lines is drawn"),
                                                 HasSubstr("--layer roads draws them"))));
  }
}

TEST_F(RoadLines, ARiverIsNoRoadWhereTheRoadsAreAllTooNarrow) {
  const std::string paths = geojson({feature(R"("highway":"footway")", at(-150, 40), at(150, 40))});
  std::filesystem::rename(paths, folder / "paths.geojson");
  const std::string rivers = geojson({feature(R"("name":"Firat")", at(-190, -90), at(190, -40))});
  EXPECT_EQ(code_of([&] {
              read_road_network({(folder / "paths.geojson").string(), rivers}, {}, RoadRules(), kZone);
            }),
            "source-without-roads");
}

TEST_F(RoadLines, CurvesAreDrawnHoweverTheyAreNested) {
  const char* const collections[] = {
      "CIRCULARSTRING(1000 0,1050 50,1100 0)", "COMPOUNDCURVE((1000 -50,1000 0),CIRCULARSTRING(1000 0,1050 50,1100 0))",
      "MULTICURVE((1000 -50,1000 0),CIRCULARSTRING(1000 0,1050 50,1100 0))",
      "GEOMETRYCOLLECTION(POINT(1000 0),MULTICURVE(CIRCULARSTRING(1000 0,1050 50,1100 0)))"};
  for (const char* wkt : collections) {
    const std::string path = (folder / "curves.csv").string();
    std::ofstream(path) << "highway,WKT\nprimary,\"" << wkt << "\"\n";
    VectorOptions options;
    options.crs = "EPSG:32637";
    const RoadNetwork network = read_road_network({path}, options, RoadRules(), kZone);
    EXPECT_TRUE(std::ranges::any_of(network.points, [](GridPoint p) { return p.north_m > 49.0; })) << wkt;
  }
}

TEST_F(RoadLines, FollowTheParallelThatTheyAreStraightAlongInDegrees) {
  const LatLon centre = kZone.unproject(kCentre);
  const LatLon from{centre.lat_deg, centre.lon_deg - 0.3};
  const LatLon to{centre.lat_deg, centre.lon_deg + 0.3};
  const auto line = [](double first_lon, double last_lon, double lat) {
    return fmt::format(R"({{"type":"Feature","properties":{{"highway":"primary"}},"geometry":{{"type":"LineString",)"
                       R"("coordinates":[[{0},{2}],[{1},{2}]]}}}})",
                       first_lon, last_lon, lat);
  };
  const RoadNetwork network =
      read_road_network({geojson({line(from.lon_deg, to.lon_deg, centre.lat_deg)})}, {}, RoadRules(), kZone);
  ASSERT_GT(network.points.size(), 20U);
  EXPECT_EQ(network.lines.front().points, network.points.size());
  for (std::size_t i = 1; i < network.points.size(); ++i) {
    const GridPoint a = network.points[i - 1];
    const GridPoint b = network.points[i];
    EXPECT_LT(std::hypot(b.east_m - a.east_m, b.north_m - a.north_m), 2100.0);
    const GridPoint middle{(a.east_m + b.east_m) / 2.0, (a.north_m + b.north_m) / 2.0};
    EXPECT_NEAR((kZone.unproject(middle).lat_deg - centre.lat_deg) * 111e3, 0.0, 0.2);
  }
}

TEST_F(RoadLines, GoTheShortWayAcrossThe180thMeridian) {
  const std::string path = geojson({R"({"type":"Feature","properties":{"highway":"primary"},"geometry":)"
                                    R"({"type":"LineString","coordinates":[[179.9,-17],[-179.9,-17]]}})"});
  VectorOptions options;
  options.extent = "179.9,-17.1,-179.9,-16.9";
  const UtmZone zone = *UtmZone::from_epsg(32760);
  const RoadNetwork network = read_road_network({path}, options, RoadRules(), zone);
  ASSERT_GT(network.points.size(), 9U);
  for (const GridPoint& point : network.points) EXPECT_NEAR(point.east_m, zone.project({-17, 180}).east_m, 11e3);
}

TEST_F(RoadLines, LinesBesideAreasInOneGeometryAreTakenOutOfIt) {
  const std::string path = (folder / "mixed.csv").string();
  std::ofstream(path)
      << "highway,WKT\nprimary,\"GEOMETRYCOLLECTION(POLYGON((1000 0,1009 0,1009 9,1000 0)),POINT(1005 5),"
         "GEOMETRYCOLLECTION(LINESTRING(1000 0,1100 0),MULTILINESTRING((1000 50,1100 50))))\"\n";
  VectorOptions options;
  options.crs = "EPSG:32637";
  const RoadNetwork network = read_road_network({path}, options, RoadRules(), kZone);
  EXPECT_EQ(network.lines.size(), 2U);
  EXPECT_EQ(network.left_out, 0);
  EXPECT_EQ(network.covered.size(), 1U);
}

/// Lines in the reference system, in a GeoPackage: other formats have no coordinates that are no numbers.
std::string geopackage(const std::filesystem::path& path, const OGRSpatialReference& crs,
                       const std::vector<std::vector<GridPoint>>& lines) {
  require_gdal();
  GDALDriver& driver = *GetGDALDriverManager()->GetDriverByName("GPKG");
  const DatasetPtr file(driver.Create(path.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  OGRSpatialReference reference = crs;
  OGRLayer& layer = *file->CreateLayer("roads", &reference, wkbLineString);
  for (const std::vector<GridPoint>& points : lines) {
    OGRLineString line;
    for (const GridPoint p : points) line.addPoint(p.east_m, p.north_m);
    OGRFeature road(layer.GetLayerDefn());
    road.SetGeometry(&line);
    EXPECT_EQ(layer.CreateFeature(&road), OGRERR_NONE);
  }
  return path.string();
}

TEST_F(RoadLines, WithCoordinatesOfNoPlaceOnEarthAreLeftOutAndSaidSo) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const auto place = [](double east, double north) {
    const LatLon p = kZone.unproject(at(east, north));
    return GridPoint{p.lon_deg, p.lat_deg};
  };
  const std::vector<GridPoint> road{place(-100, -100), place(100, 100)};
  const std::vector<GridPoint> wrong[] = {{place(0, 0), {38.0, 95.0}},
                                          {{kNaN, kNaN}, place(0, 0)},
                                          {place(0, 0), {38.0, kNaN}},
                                          {place(0, 0), {1e30, 37.0}},
                                          {place(0, 0), {-400.0, 37.0}}};
  for (const std::vector<GridPoint>& line : wrong) {
    for (const bool first : {true, false}) {
      const auto lines = first ? std::vector{line, road, road} : std::vector{road, road, line};
      const std::string path = geopackage(folder / "roads.gpkg", wgs84_reference(), lines);
      EXPECT_NEAR(kZone.project(centre_of_roads({path}, {})).east_m, kCentre.east_m, 1.0);
      const RoadNetwork network = read_road_network({path}, {}, RoadRules(), kZone);
      EXPECT_EQ(network.lines.size(), 2U);
      EXPECT_EQ(network.left_out, 1);
      EXPECT_NEAR(network.covered.front().box().width_m(), 200.0, 10.0);
      EXPECT_THAT(network.notes,
                  Contains(HasSubstr(fmt::format("1 of 3 lines are left out, since no place on Earth has "
                                                 "their coordinates; the first is feature {} of layer "
                                                 "'roads' of ",
                                                 first ? 1 : 3))));
      std::filesystem::remove(path);
    }
  }
  const std::vector<GridPoint> metres{at(0, 0), at(100, 100)};
  const std::string declared = geopackage(folder / "metres.gpkg", wgs84_reference(), {metres, road, metres});
  EXPECT_EQ(code_of([&] { read_road_network({declared}, {}, RoadRules(), kZone); }), "crs-not-transformable");
  EXPECT_THAT(message_of([&] { centre_of_roads({geopackage(folder / "all.gpkg", wgs84_reference(), {metres})}, {}); }),
              HasSubstr("no place on Earth; if the reference system is wrong, give the right one with --crs"));
  const std::string plane =
      geopackage(folder / "plane.gpkg", utm_reference(kZone), {metres, {at(0, 50), {1e30, at(0, 0).north_m}}});
  EXPECT_NEAR(kZone.project(centre_of_roads({plane}, {})).east_m, kCentre.east_m + 50.0, 1.0);
  EXPECT_EQ(read_road_network({plane}, {}, RoadRules(), kZone).lines.size(), 1U);
}

TEST_F(RoadLines, TooFarFromTheZoneForAPlaceInItMakeNoFileADamagedOne) {
  const std::string there = R"({"type":"Feature","properties":{},"geometry":)"
                            R"({"type":"LineString","coordinates":[[129,0],[129,0.5]]}})";
  const std::string path = geojson({feature(R"("name":"Yol")", at(-50, 0), at(50, 0)), there});
  const RoadNetwork network = read_road_network(
      {path}, {.crs = "", .layer = "", .extent = testing::extent_around_centre(100)}, RoadRules(), kZone);
  EXPECT_EQ(network.lines.size(), 1U);
  EXPECT_EQ(network.left_out, 1);
  EXPECT_THAT(network.notes, Not(Contains(HasSubstr("no place on Earth"))));
}

TEST_F(RoadLines, AreasOfRoadBesideThemAreNotDrawnAndSaidSo) {
  const auto area = [](const std::string& properties, double east) {
    return fmt::format(
        R"({{"type":"Feature","properties":{{{}}},"geometry":{{"type":"Polygon","coordinates":[[{},{},{},{}]]}}}})",
        properties, degrees(at(east, 0)), degrees(at(east + 20, 0)), degrees(at(east, 20)), degrees(at(east, 0)));
  };
  for (const char* properties : {R"("highway":"pedestrian")", R"("name":"Meydan")"}) {
    const std::string line = feature(properties, at(0, 0), at(100, 100));
    EXPECT_THAT(notes({line, area(properties, 0), area(properties, 50)}),
                Contains(AllOf(HasSubstr("the ground of 2 counts as no road"), HasSubstr("gdal_rasterize"))));
    std::vector<std::string> town(100, line);
    town.push_back(area(properties, 0));
    EXPECT_THAT(notes(town), Not(Contains(HasSubstr("areas"))));
  }
  const std::string road = feature(R"("highway":"primary")", at(0, 0), at(100, 100));
  EXPECT_THAT(notes({road, area(R"("highway":"services")", 0), area(R"("building":"yes")", 50)}), IsEmpty());
}

TEST_F(RoadLines, DrawnByHandButNotClassifiedAreNotDrawnAndSaidSo) {
  const std::string classified = feature(R"("highway":"primary")", at(0, 0), at(100, 0));
  const std::string forgotten = feature(R"("highway":null,"name":"Yeni Cadde")", at(0, 50), at(100, 50));
  EXPECT_THAT(notes({classified, forgotten}),
              ElementsAre(AllOf(HasSubstr("1 of 2 lines"), HasSubstr("attribute 'highway' is empty"))));
  EXPECT_THAT(message_of([&] { read_road_network({geojson({forgotten})}, {}, RoadRules(), kZone); }),
              AllOf(HasSubstr("attribute 'highway' is empty"), HasSubstr("--class-attribute")));
  const std::string river = feature(R"("highway":null,"waterway":"river")", at(0, 50), at(100, 50));
  EXPECT_THAT(notes({classified, river}), IsEmpty());
}

TEST_F(RoadLines, WithoutGeometriesAreLeftOutAndSaidSo) {
  const auto nowhere = [](const std::string& road_class, const std::string& geometry) {
    return fmt::format(R"({{"type":"Feature","properties":{{"highway":"{}"}},"geometry":{}}})", road_class, geometry);
  };
  const std::string empty = R"({"type":"LineString","coordinates":[]})";
  EXPECT_THAT(notes({road(0, 0), road(50, 0), nowhere("footway", "null")}), IsEmpty()) << "it would not be drawn";
  EXPECT_THAT(notes({road(0, 0), road(50, 0), nowhere("primary", "null"), nowhere("primary", empty)}),
              ElementsAre(HasSubstr("2 of 4 lines have no geometry")));
}

TEST_F(RoadLines, OfAShapefileWithoutFeaturesAreNone) {
  const std::string path = (folder / "empty.shp").string();
  {
    require_gdal();
    OGRSpatialReference plane = utm_reference(kZone);
    const DatasetPtr file(
        GetGDALDriverManager()->GetDriverByName("ESRI Shapefile")->Create(path.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    ASSERT_NE(file->CreateLayer("empty", &plane, wkbLineString), nullptr);
  }
  EXPECT_THAT(message_of([&] { centre_of_roads({path}, {}); }), HasSubstr("no feature has a geometry"));
}

TEST_F(RoadLines, FilesThatHoldNoRoadsAreRefused) {
  const std::string rivers = geojson({feature(R"("highway":"footway")", at(0, 0), at(9, 9))});
  EXPECT_EQ(code_of([&] { open_road_vectors({rivers}, {}, RoadRules(), kZone, 2.0); }), "source-without-roads");
  const std::string squares = geojson({R"({"type":"Feature","properties":{"highway":"pedestrian"},"geometry":)"
                                       R"({"type":"Polygon","coordinates":[[[38,37],[39,37],[39,38],[38,37]]]}})"});
  EXPECT_THAT(message_of([&] { read_road_network({squares}, {}, RoadRules(), kZone); }),
              HasSubstr("none of its 1 features is drawn as a road: none of them is a line"));
  std::ofstream(folder / "bad.geojson") << R"({"type":"FeatureCollection","features":[{"type":)";
  EXPECT_EQ(code_of([&] { read_road_network({(folder / "bad.geojson").string()}, {}, RoadRules(), kZone); }),
            "source-unreadable");
  VectorOptions options;
  options.layer = "motorways";
  EXPECT_EQ(message_of([&] { read_road_network({rivers}, options, RoadRules(), kZone); }),
            rivers + ": has no layer 'motorways'; it has 'roads'");
  EXPECT_EQ(code_of([&] { centre_of_roads({rivers}, options); }), "layer-unknown");
  options = {};
  options.extent = "12,13,11,14";
  const std::string roads = geojson({feature(R"("highway":"primary")", at(0, 0), at(9, 9))});
  EXPECT_EQ(code_of([&] { read_road_network({roads}, options, RoadRules(), kZone); }), "extent-unreadable");
}

}  // namespace
}  // namespace roadfix
