#include "tiles/sources/vector_roads.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "core/units/error.hpp"
#include "tests/support/code_of.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tiles/sources/gdal_session.hpp"
#include "tiles/sources/vector_file.hpp"

namespace roadfix {
namespace {

using ::testing::AllOf;
using testing::code_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::message_of;

const UtmZone kZone = *UtmZone::from_epsg(32637);
constexpr GridPoint kCentre{400000.0, 4200000.0};

std::string degrees(GridPoint p) {
  const LatLon place = kZone.unproject(p);
  return fmt::format("[{:.9f},{:.9f}]", place.lon_deg, place.lat_deg);
}

std::string feature(const std::string& properties, GridPoint from, GridPoint to) {
  return fmt::format(
      R"({{"type":"Feature","properties":{{{}}},"geometry":{{"type":"LineString","coordinates":[{},{}]}}}})",
      properties, degrees(from), degrees(to));
}

GridPoint at(double east, double north) { return {kCentre.east_m + east, kCentre.north_m + north}; }

std::string extent_around_centre(double half_m) {
  const LatLon low = kZone.unproject(at(-half_m, -half_m));
  const LatLon high = kZone.unproject(at(half_m, half_m));
  return fmt::format("{},{},{},{}", low.lon_deg, low.lat_deg, high.lon_deg, high.lat_deg);
}

class VectorRoads : public ::testing::Test {
 protected:
  std::string geojson(const std::vector<std::string>& features) {
    std::ofstream file(folder / "roads.geojson");
    file << R"({"type":"FeatureCollection","features":[)";
    for (std::size_t i = 0; i < features.size(); ++i) file << (i > 0 ? "," : "") << features[i];
    file << "]}";
    return (folder / "roads.geojson").string();
  }
  static CellArray cells(const CellSource& source) { return source.read(kWindow, 1); }
  static constexpr GridGeometry kWindow{2.0, {199900, -2100100}, 200, 200};  // 200 m around the centre
  testing::TemporaryFolder folder;
};

TEST_F(VectorRoads, LieWhereTheyAreAsWideAsTheirClass) {
  const std::string path = geojson({feature(R"("highway":"primary")", at(-150, 40), at(150, 40)),
                                    feature(R"("highway":"footway")", at(-150, -40), at(150, -40)),
                                    feature(R"("highway":"service","tunnel":"yes")", at(-150, -90), at(150, -90))});
  const auto source = open_road_vectors({path}, {}, RoadRules(), kZone, 2.0);
  EXPECT_EQ(source->summary().features, 1);
  EXPECT_EQ(source->summary().left_out, 2);
  const CellArray result = cells(*source);
  const Certainty certainty;
  for (int row = 0; row < result.rows(); ++row) {
    const double north = kWindow.cell_center(0, row).north_m - kCentre.north_m;
    const Cell cell = result.at(100, row);
    if (std::abs(north + 90.0) < 2.0 || std::abs(north - 40.0) < 2.0) continue;  // the rims of the layer's extent
    if (north > 40.0 || north < -90.0) {
      EXPECT_EQ(cell, kUnobserved) << north;
    } else if (std::abs(north - 40.0) < 4.0) {
      EXPECT_EQ(cell, cell_from_probability(certainty.on_road)) << north;
    } else if (std::abs(north - 40.0) > 6.0) {
      EXPECT_EQ(cell, cell_from_probability(certainty.elsewhere)) << north;
    }
  }
}

TEST_F(VectorRoads, GroundBesideTheExtentIsUnobserved) {
  const std::string path = geojson({feature(R"("highway":"primary")", at(-50, -50), at(50, 50))});
  const CellArray own = cells(*open_road_vectors({path}, {}, RoadRules(), kZone, 2.0));
  EXPECT_NEAR(static_cast<double>(own.observed_count()), 2500.0, 110.0);
  VectorOptions options;
  options.extent = extent_around_centre(100);
  const CellArray stated = cells(*open_road_vectors({path}, options, RoadRules(), kZone, 2.0));
  EXPECT_NEAR(static_cast<double>(stated.observed_count()), 10000.0, 300.0);
}

TEST_F(VectorRoads, OfAnExtentFileWhatIsInAPolygonAndNotInItsHolesIsKnown) {
  const std::string path = geojson({feature(R"("highway":"primary")", at(-150, 0), at(150, 0))});
  const auto ring = [](double half_m) {
    return fmt::format("({0} {2},{1} {2},{1} {3},{0} {3},{0} {2})", kCentre.east_m - half_m, kCentre.east_m + half_m,
                       kCentre.north_m - half_m, kCentre.north_m + half_m);
  };
  const std::string known = (folder / "known.gpkg").string();
  require_gdal();
  {
    const DatasetPtr file(
        GetGDALDriverManager()->GetDriverByName("GPKG")->Create(known.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    OGRSpatialReference plane = utm_reference(kZone);
    OGRLayer* layer = file->CreateLayer("known", &plane, wkbUnknown);
    for (const std::string& wkt :
         {std::string("POLYGON EMPTY"), fmt::format("MULTIPOLYGON(({},{}))", ring(100), ring(50))}) {
      OGRGeometry* geometry = nullptr;
      OGRGeometryFactory::createFromWkt(wkt.c_str(), nullptr, &geometry);
      OGRFeature feature(layer->GetLayerDefn());
      feature.SetGeometryDirectly(geometry);
      ASSERT_EQ(layer->CreateFeature(&feature), OGRERR_NONE);
    }
  }
  VectorOptions options;
  options.extent = known;
  const CellArray result = cells(*open_road_vectors({path}, options, RoadRules(), kZone, 2.0));
  EXPECT_EQ(result.observed_count(), 100U * 100U - 50U * 50U);
  EXPECT_TRUE(is_observed(result.at(60, 100)));
  EXPECT_FALSE(is_observed(result.at(100, 100))) << "in the hole";
  EXPECT_FALSE(is_observed(result.at(40, 100))) << "outside";
}

TEST_F(VectorRoads, TheCentreIsThatOfTheGroundThatIsAskedFor) {
  const std::string path = geojson({feature(R"("highway":"primary")", at(-9000, 0), at(0, 0))});
  EXPECT_NEAR(kZone.project(centre_of_roads({path}, {})).east_m, kCentre.east_m - 4500.0, 1.0);
  VectorOptions options;
  options.extent = extent_around_centre(100);
  EXPECT_NEAR(kZone.project(centre_of_roads({path}, options)).east_m, kCentre.east_m, 1.0);
  const std::string known = (folder / "known.geojson").string();
  std::ofstream(known) << R"({"type":"Feature","properties":{},"geometry":{"type":"Polygon","coordinates":[[)"
                       << degrees(at(-9, -9)) << ',' << degrees(at(9, -9)) << ',' << degrees(at(9, 9)) << ','
                       << degrees(at(-9, -9)) << "]]}}";
  options.extent = known;
  EXPECT_NEAR(kZone.project(centre_of_roads({path}, options)).east_m, kCentre.east_m, 1.0);
}

TEST_F(VectorRoads, AnExtentMayCrossTheAntimeridian) {
  const std::string path = geojson({R"({"type":"Feature","properties":{"highway":"primary"},"geometry":)"
                                    R"({"type":"LineString","coordinates":[[179.995,-17],[180,-17]]}})",
                                    R"({"type":"Feature","properties":{"highway":"primary"},"geometry":)"
                                    R"({"type":"LineString","coordinates":[[-180,-17],[-179.995,-17]]}})"});
  VectorOptions options;
  options.extent = "179.99,-17.01,-179.99,-16.99";
  const LatLon centre = centre_of_roads({path}, options);
  const UtmZone zone = *UtmZone::from_epsg(32760);
  EXPECT_EQ(UtmZone::containing({centre.lat_deg, centre.lon_deg - 1e-6}), zone);
  const auto source = open_road_vectors({path}, options, RoadRules(), zone, 2.0);
  const GridPoint middle = zone.project({-17.0, 180.0});
  const CellArray result =
      source->read(GridGeometry::covering(
                       {{middle.east_m - 300, middle.north_m - 300}, {middle.east_m + 300, middle.north_m + 300}}, 2.0),
                   1);
  EXPECT_EQ(result.observed_count(), result.cells().size());
  for (const int col : {30, 150, 270}) EXPECT_GT(result.at(col, 150), kRoad / 2) << col;
  EXPECT_LT(result.at(150, 250), kRoad / 2);
}

TEST_F(VectorRoads, AStraightRoadAloneIsKnownWithTheGroundBesideIt) {
  const auto check = [](const std::string& path, const std::string& crs, const std::string& about) {
    VectorOptions options;
    options.crs = crs;
    const CellArray result = cells(*open_road_vectors({path}, options, RoadRules(), kZone, 2.0));
    const Certainty certainty;
    double road_cells = 0.0;
    for (const Cell cell : result.cells()) {
      if (cell == kUnobserved) continue;
      road_cells += (probability(cell) - certainty.elsewhere) / (certainty.on_road - certainty.elsewhere);
    }
    EXPECT_NEAR(static_cast<double>(result.observed_count()), 200.0 * 32.0 / 4.0, 60.0) << about;
    EXPECT_NEAR(road_cells, 200.0 * 10.0 / 4.0, 25.0) << about;
  };
  const std::string degrees_east = fmt::format(
      R"({{"type":"Feature","properties":{{"highway":"primary"}},"geometry":{{"type":"LineString","coordinates":[[{0},{2}],[{1},{2}]]}}}})",
      kZone.unproject(at(-100, 0)).lon_deg, kZone.unproject(at(100, 0)).lon_deg, kZone.unproject(at(0, 0)).lat_deg);
  check(geojson({degrees_east}), "", "along a parallel");
  check(geojson({feature(R"("highway":"primary")", at(-100, 0), at(100, 0.1))}), "", "nearly along a parallel");
  for (const char* line : {"399900 4200000,400100 4200000", "400000 4199900,400000 4200100"}) {
    std::ofstream(folder / "line.csv") << "highway,WKT\nprimary,\"LINESTRING(" << line << ")\"\n";
    check((folder / "line.csv").string(), "EPSG:32637", line);
  }
}

TEST_F(VectorRoads, AreTheSameHoweverTheGroundIsCutIntoBlocks) {
  std::vector<std::string> features;
  for (int i = 0; i < 30; ++i) {
    features.push_back(feature(R"("highway":"residential")", at(-180 + 12 * i, -190), at(190 - 11 * i, 170 - 3 * i)));
  }
  const auto source = open_road_vectors({geojson(features)}, {}, RoadRules(), kZone, 2.0);
  const CellArray whole = cells(*source);
  CellArray joined(kWindow.cols, kWindow.rows);
  for (int row = 0; row < kWindow.rows; row += 40) {
    for (int col = 0; col < kWindow.cols; col += 50) {
      paste(source->read({2.0, {kWindow.origin.col + col, kWindow.origin.row + row}, 50, 40}, 1), joined, col, row);
    }
  }
  EXPECT_EQ(joined, whole);
}

TEST_F(VectorRoads, ARoadToAPointOfNoPlaceCostsNoMoreThanItsLength) {
  // The square around it has 50 million squares of the index.
  const std::string path = geojson({feature(R"("highway":"primary")", at(-150, 0), at(150, 0)),
                                    R"({"type":"Feature","properties":{"highway":"primary"},"geometry":)"
                                    R"({"type":"LineString","coordinates":[)" +
                                        degrees(at(0, 100)) + ",[0,0]]}}"});
  VectorOptions options;
  options.extent = extent_around_centre(150);
  const CellArray result = cells(*open_road_vectors({path}, options, RoadRules(), kZone, 2.0));
  const Cell road = cell_from_probability(Certainty().on_road);
  EXPECT_EQ(result.at(100, 100), road);
  EXPECT_EQ(result.at(100, 50), road) << "where the long one begins";
}

TEST_F(VectorRoads, OpenStreetMapXmlIsReadWithAllItsTags) {
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

TEST_F(VectorRoads, ClassesOfGeofabriksExtractsAreKnown) {
  const std::string path = geojson({feature(R"("fclass":"primary")", at(-150, 40), at(150, 40)),
                                    feature(R"("fclass":"footway")", at(-150, -40), at(150, -40))});
  const RoadNetwork network = read_road_network({path}, {}, RoadRules(), kZone);
  ASSERT_EQ(network.lines.size(), 1U);
  EXPECT_EQ(network.lines.front().half_width_m, 5.0);
}

TEST_F(VectorRoads, AnotherAttributeIsTakenForTheClassWhereItHoldsClassesAndSaidSo) {
  const std::string path = geojson({feature(R"("TYPE":"primary")", at(-150, 40), at(150, 40)),
                                    feature(R"("TYPE":"footway")", at(-150, -40), at(150, -40))});
  const RoadNetwork network = read_road_network({path}, {}, RoadRules(), kZone);
  ASSERT_EQ(network.lines.size(), 1U);
  EXPECT_EQ(network.lines.front().half_width_m, 5.0);
  EXPECT_EQ(network.class_attribute, "type");
  EXPECT_THAT(network.notes, ElementsAre(HasSubstr("'type'")));
  EXPECT_THAT(open_road_vectors({path}, {}, RoadRules(), kZone, 2.0)->summary().method, HasSubstr("classes in type"));
}

TEST_F(VectorRoads, ClassesInCapitalsAreClassesAndUnknownOnesAreNamedAsTheyStand) {
  const std::string path = geojson({feature(R"("ROADTYPE":"PRIMARY")", at(-150, 40), at(150, 40)),
                                    feature(R"("ROADTYPE":"Residential ")", at(-150, 0), at(150, 0)),
                                    feature(R"("ROADTYPE":"Feldweg")", at(-150, -40), at(150, -40))});
  RoadRules rules;
  rules.set_class_attribute("roadtype");
  const RoadNetwork network = read_road_network({path}, {}, rules, kZone);
  ASSERT_EQ(network.lines.size(), 2U);
  EXPECT_EQ(network.lines.front().half_width_m, 5.0);
  EXPECT_EQ(network.lines.back().half_width_m, 3.0);
  EXPECT_THAT(network.notes, ElementsAre(HasSubstr("Feldweg (1)")));
}

TEST_F(VectorRoads, LinesWithoutClassesAreAllRoadsAndSaidSo) {
  const std::string path = geojson({feature(R"("type":"A","lanes":4)", at(-150, 40), at(150, 40)),
                                    feature(R"("type":"primary","lanes":2)", at(-150, -40), at(150, -40)),
                                    feature(R"("type":"B","lanes":2)", at(-150, -90), at(150, -90))});
  const RoadNetwork network = read_road_network({path, path}, {}, RoadRules(), kZone);
  EXPECT_EQ(network.lines.size(), 6U);
  EXPECT_THAT(network.class_attribute, IsEmpty());
  EXPECT_THAT(network.notes, ElementsAre(AllOf(HasSubstr("type, lanes"), HasSubstr("--class-attribute"))));
}

TEST_F(VectorRoads, RiversBesideClassifiedRoadsAreNotDrawnAndSaidSo) {
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
    EXPECT_THAT(network.notes, ElementsAre(AllOf(HasSubstr("layer 'roads'"), HasSubstr("none of its lines is drawn"))));
  }
}

TEST_F(VectorRoads, ARiverIsNoRoadWhereTheRoadsAreAllTooNarrow) {
  const std::string paths = geojson({feature(R"("highway":"footway")", at(-150, 40), at(150, 40))});
  std::filesystem::rename(paths, folder / "paths.geojson");
  const std::string rivers = geojson({feature(R"("name":"Firat")", at(-190, -90), at(190, -40))});
  EXPECT_EQ(code_of([&] {
              read_road_network({(folder / "paths.geojson").string(), rivers}, {}, RoadRules(), kZone);
            }),
            "source-without-roads");
}

TEST_F(VectorRoads, CurvesAreDrawnHoweverTheyAreNested) {
  const char* const collections[] = {"CIRCULARSTRING(0 0,50 50,100 0)",
                                     "COMPOUNDCURVE((0 -50,0 0),CIRCULARSTRING(0 0,50 50,100 0))",
                                     "MULTICURVE((0 -50,0 0),CIRCULARSTRING(0 0,50 50,100 0))",
                                     "GEOMETRYCOLLECTION(POINT(0 0),MULTICURVE(CIRCULARSTRING(0 0,50 50,100 0)))"};
  for (const char* wkt : collections) {
    const std::string path = (folder / "curves.csv").string();
    std::ofstream(path) << "highway,WKT\nprimary,\"" << wkt << "\"\n";
    VectorOptions options;
    options.crs = "EPSG:32637";
    const RoadNetwork network = read_road_network({path}, options, RoadRules(), kZone);
    EXPECT_TRUE(std::ranges::any_of(network.points, [](GridPoint p) { return p.north_m > 49.0; })) << wkt;
  }
}

TEST_F(VectorRoads, LinesBesideAreasInOneGeometryAreTakenOutOfIt) {
  const std::string path = (folder / "mixed.csv").string();
  std::ofstream(path) << "highway,WKT\nprimary,\"GEOMETRYCOLLECTION(POLYGON((0 0,9 0,9 9,0 0)),POINT(5 5),"
                         "GEOMETRYCOLLECTION(LINESTRING(0 0,100 0),MULTILINESTRING((0 50,100 50))))\"\n";
  VectorOptions options;
  options.crs = "EPSG:32637";
  const RoadNetwork network = read_road_network({path}, options, RoadRules(), kZone);
  EXPECT_EQ(network.lines.size(), 2U);
  EXPECT_EQ(network.left_out, 0);
  EXPECT_EQ(network.covered.size(), 1U);
}

TEST_F(VectorRoads, ClassesThatNoRuleKnowsAreNamed) {
  const std::string some = geojson({feature(R"("highway":"primary")", at(-150, 40), at(150, 40)),
                                    feature(R"("highway":"Feldweg")", at(-150, 0), at(150, 0)),
                                    feature(R"("highway":"Feldweg")", at(-150, -20), at(150, -20)),
                                    feature(R"("highway":"Autobahn")", at(-150, -40), at(150, -40))});
  const RoadNetwork network = read_road_network({some}, {}, RoadRules(), kZone);
  EXPECT_EQ(network.left_out, 3);
  EXPECT_THAT(network.notes, ElementsAre(AllOf(HasSubstr("3 of 4 lines"), HasSubstr("Feldweg (2), Autobahn (1)"))));
  const std::string none = geojson({feature(R"("highway":"Feldweg")", at(-150, 0), at(150, 0))});
  EXPECT_THAT(message_of([&] { read_road_network({none}, {}, RoadRules(), kZone); }), HasSubstr("Feldweg (1)"));
}

TEST_F(VectorRoads, FilesThatHoldNoRoadsAreRefused) {
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

TEST_F(VectorRoads, AnEmptyFileIsCalledEmptyAndBesideOthersItCostsNothing) {
  const std::string empty = (folder / "empty.geojson").string();
  std::ofstream(empty) << R"({"type":"FeatureCollection","features":[]})";
  EXPECT_THAT(message_of([&] { read_road_network({empty}, {}, RoadRules(), kZone); }), HasSubstr("it is empty"));
  EXPECT_THAT(message_of([&] { centre_of_roads({empty}, {}); }), HasSubstr("it is empty"));
  const std::string roads = geojson({feature(R"("highway":"primary")", at(-50, 0), at(50, 0))});
  EXPECT_EQ(read_road_network({empty, roads}, {}, RoadRules(), kZone).lines.size(), 1U);
  EXPECT_NEAR(kZone.project(centre_of_roads({empty, roads}, {})).east_m, kCentre.east_m, 1.0);
}

TEST_F(VectorRoads, ALayerIsTakenFromThoseFilesOfAFolderThatHaveIt) {
  const std::string roads = geojson({feature(R"("highway":"primary")", at(-50, 0), at(50, 0))});
  const std::string rivers = (folder / "rivers.geojson").string();
  std::filesystem::copy_file(roads, rivers);
  VectorOptions options;
  options.layer = "roads";
  EXPECT_EQ(read_road_network({rivers, roads}, options, RoadRules(), kZone).lines.size(), 1U);
  EXPECT_NEAR(kZone.project(centre_of_roads({rivers, roads}, options)).east_m, kCentre.east_m, 1.0);
}

TEST_F(VectorRoads, TablesWithoutGeometriesBesideTheRoadsAreNoConcern) {
  const std::string roads = geojson({feature(R"("highway":"primary")", at(-50, 0), at(50, 0))});
  const std::string path = (folder / "project.gpkg").string();
  {
    const DatasetPtr from = open_dataset(roads, GDAL_OF_VECTOR);
    GDALDriver& driver = *GetGDALDriverManager()->GetDriverByName("GPKG");
    const DatasetPtr to(driver.Create(path.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    to->CreateLayer("layer_styles", nullptr, wkbNone, nullptr);
    to->CopyLayer(from->GetLayer(0), "roads");
  }
  EXPECT_EQ(read_road_network({path}, {}, RoadRules(), kZone).lines.size(), 1U);
}

TEST(VectorTileName, TellsZoomColumnAndRow) {
  for (const char* path : {"a/12-1407-2471.mvt", "12-1407-2471.mvt", "tiles/12/1407/2471.pbf"}) {
    const auto tile = vector_tile_of(path);
    ASSERT_TRUE(tile) << path;
    EXPECT_EQ(tile->zoom, 12);
    EXPECT_EQ(tile->x, 1407);
    EXPECT_EQ(tile->y, 2471);
  }
  for (const char* path : {"monaco.osm.pbf", "2-9-1.mvt", "12-1407.mvt", "99-1-1.mvt", "x12-1-1.mvt"}) {
    EXPECT_FALSE(vector_tile_of(path)) << path;
  }
}

}  // namespace
}  // namespace roadfix
