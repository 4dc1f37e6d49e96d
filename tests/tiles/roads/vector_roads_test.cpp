#include "tiles/roads/vector_roads.hpp"

#include <gmock/gmock.h>
#include <ogrsf_frmts.h>

#include <cmath>
#include <fstream>
#include <string>

#include "tests/support/code_of.hpp"
#include "tests/tiles/roads/vector_roads_fixture.hpp"
#include "tiles/sources/certainty.hpp"
#include "tiles/sources/gdal_session.hpp"

namespace roadfix {
namespace {

using testing::at;
using testing::degrees;
using testing::extent_around_centre;
using testing::feature;
using testing::kCentre;
using testing::kZone;
using testing::VectorRoads;

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

TEST_F(VectorRoads, OnAnOldEllipsoidNeedADatumToLieAnywhere) {
  const std::string path = geojson({feature(R"("highway":"primary")", at(-50, -50), at(50, 50))});
  VectorOptions options;
  options.crs = "+proj=longlat +ellps=intl +no_defs";
  EXPECT_EQ(testing::code_of([&] { open_road_vectors({path}, options, RoadRules(), kZone, 2.0); }), "datum-unknown");
  EXPECT_EQ(testing::code_of([&] { centre_of_roads({path}, options); }), "datum-unknown");
}

TEST_F(VectorRoads, NeedAWayFromTheirDatumAroundWhereTheyLie) {
  const std::string path = (folder / "damascus.geojson").string();
  std::ofstream(path) << R"({"type":"Feature","properties":{"highway":"primary"},"geometry":{"type":"LineString",)"
                      << R"("coordinates":[[6797000,3711000],[6797300,3711100]]}})";
  VectorOptions options;
  options.crs = "EPSG:28406";  // Pulkovo 1942, from which ways are known elsewhere
  EXPECT_EQ(testing::code_of([&] { open_road_vectors({path}, options, RoadRules(), kZone, 2.0); }), "datum-unknown");
}

TEST_F(VectorRoads, AreAsUncertainAsTheWayFromTheirDatum) {
  // The registry states 20 m of PSAD56 in Chile, 5 m of SAD69 in Brazil and 2 m of ED50 in Turkey.
  const auto summary_of = [&](const char* crs, double lon, double lat, int zone) {
    const std::string path = (folder / "roads.geojson").string();
    std::ofstream(path) << fmt::format(
        R"({{"type":"Feature","properties":{{"highway":"primary"}},"geometry":{{"type":"LineString",)"
        R"("coordinates":[[{0},{1}],[{2},{1}]]}}}})",
        lon, lat, lon + 0.01);
    VectorOptions options;
    options.crs = crs;
    return open_road_vectors({path}, options, RoadRules(), *UtmZone::from_epsg(zone), 2.0)->summary();
  };
  const SourceSummary rough = summary_of("EPSG:4248", -72.0, -33.0, 32718);
  EXPECT_NEAR(rough.registration_sigma_m, std::hypot(20.0, 4.0), 1e-9);
  EXPECT_THAT(rough.notes, ::testing::Contains(::testing::HasSubstr("known to 20 m only")));
  EXPECT_NEAR(summary_of("EPSG:4618", -48.0, -15.0, 32722).registration_sigma_m, std::hypot(5.0, 4.0), 1e-9);
  EXPECT_EQ(summary_of("EPSG:4230", 38.0, 37.8, 32637).registration_sigma_m, 4.0);
  EXPECT_EQ(summary_of("+proj=longlat +ellps=intl +towgs84=-87,-98,-121", 38.0, 37.8, 32637).registration_sigma_m, 4.0);
}

TEST_F(VectorRoads, OfAReferenceSystemThatNobodyKnowsAreNotTakenForWgs84) {
  const std::string road = feature(R"("highway":"primary")", at(-50, -50), at(50, 50));
  for (const std::string name : {"urn:ogc:def:crs:EPSG::999999", "EPSG:42 30"}) {
    const std::string path = geojson({road}, R"("crs":{"type":"name","properties":{"name":")" + name + R"("}},)");
    EXPECT_EQ(testing::code_of([&] { centre_of_roads({path}, {}); }), "crs-unknown") << name;
    VectorOptions told;
    told.crs = "EPSG:4326";
    EXPECT_EQ(testing::code_of([&] { centre_of_roads({path}, told); }), "no error") << name;
  }
  const std::string known =
      geojson({road}, R"("crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:OGC:1.3:CRS84"}},)");
  EXPECT_EQ(testing::code_of([&] { centre_of_roads({known}, {}); }), "no error");
}

TEST_F(VectorRoads, EmptyLinesLieNowhereAndStretchNothing) {
  const std::string path = geojson(
      {feature(R"("highway":"primary")", at(-50, -50), at(50, 50)),
       R"({"type":"Feature","properties":{"highway":"primary"},"geometry":{"type":"LineString","coordinates":[]}})",
       R"({"type":"Feature","properties":{"highway":"primary"},"geometry":null})"});
  const GridPoint centre = kZone.project(centre_of_roads({path}, {}));
  EXPECT_NEAR(centre.east_m, kCentre.east_m, 1.0);
  EXPECT_NEAR(centre.north_m, kCentre.north_m, 1.0);
  EXPECT_LT(open_road_vectors({path}, {}, RoadRules(), kZone, 2.0)->extent().width_m(), 120.0);
}

TEST_F(VectorRoads, CoverNoGroundOfWhatHasNoRoadClass) {
  const std::string path = geojson({feature(R"("highway":"primary")", at(-50, -50), at(50, 50)),
                                    feature(R"("highway":null,"power":"line")", at(-5000, 0), at(5000, 0)),
                                    feature(R"("highway":"bus_stop")", at(0, 5000), at(0, 5001))});
  const GridBox roads = open_road_vectors({path}, {}, RoadRules(), kZone, 2.0)->extent();
  EXPECT_LT(roads.width_m(), 120.0);
  EXPECT_LT(roads.height_m(), 120.0);
  const std::string plain =
      geojson({feature(R"("id":1)", at(-50, -50), at(50, 50)), feature(R"("id":2)", at(-5000, 0), at(5000, 0))});
  EXPECT_GT(open_road_vectors({plain}, {}, RoadRules(), kZone, 2.0)->extent().width_m(), 9000.0)
      << "without classes every line is a road";
}

TEST_F(VectorRoads, CoverTheGroundOfTheRoadsThatAreLeftInAFileNotOfThoseDeletedFromIt) {
  const std::string path = (folder / "roads.gpkg").string();
  require_gdal();
  {
    const DatasetPtr file(
        GetGDALDriverManager()->GetDriverByName("GPKG")->Create(path.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    OGRSpatialReference plane = utm_reference(kZone);
    OGRLayer* layer = file->CreateLayer("roads", &plane, wkbLineString);
    for (const double east_m : {0.0, 5000.0}) {
      OGRLineString line;
      line.addPoint(kCentre.east_m + east_m, kCentre.north_m - 50.0);
      line.addPoint(kCentre.east_m + east_m + 100.0, kCentre.north_m + 50.0);
      OGRFeature road(layer->GetLayerDefn());
      road.SetGeometry(&line);
      ASSERT_EQ(layer->CreateFeature(&road), OGRERR_NONE);
    }
  }
  {
    const DatasetPtr file = open_dataset(path, GDAL_OF_VECTOR | GDAL_OF_UPDATE);
    ASSERT_EQ(file->GetLayer(0)->DeleteFeature(2), OGRERR_NONE);
  }
  EXPECT_LT(open_road_vectors({path}, {}, RoadRules(), kZone, 2.0)->extent().width_m(), 120.0);
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

}  // namespace
}  // namespace roadfix
