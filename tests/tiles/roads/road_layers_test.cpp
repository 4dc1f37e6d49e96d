#include <fmt/format.h>
#include <gmock/gmock.h>
#include <ogrsf_frmts.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/support/code_of.hpp"
#include "tests/tiles/roads/road_features.hpp"
#include "tiles/roads/road_lines.hpp"
#include "tiles/roads/vector_roads.hpp"
#include "tiles/sources/gdal_session.hpp"

namespace roadfix {
namespace {

using testing::at;
using testing::code_of;
using testing::feature;
using ::testing::HasSubstr;
using testing::kCentre;
using testing::kZone;
using testing::message_of;

/// Which files and layers roads are read from, and which ground is theirs.
class RoadLayers : public testing::RoadFeatures {
 protected:
  std::string street() { return geojson({feature(R"("highway":"primary")", at(-50, 0), at(50, 0))}); }

  /// A new GeoPackage at package().
  DatasetPtr create_package() const {
    require_gdal();
    GDALDriver& driver = *GetGDALDriverManager()->GetDriverByName("GPKG");
    return DatasetPtr(driver.Create(package().c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  }
  /// The file's first layer, named as the file is.
  static void copy_layer(const std::string& file, GDALDataset& to) {
    to.CopyLayer(open_dataset(file, GDAL_OF_VECTOR)->GetLayer(0), std::filesystem::path(file).stem().c_str());
  }
  std::string package() const { return (folder / "project.gpkg").string(); }
};

TEST_F(RoadLayers, AcrossThe180thMeridianAskForAnExtent) {
  const auto road = [](double lon) {
    return fmt::format(
        R"({{"type":"Feature","properties":{{}},"geometry":{{"type":"LineString","coordinates":[[{},-16.5],[{},-16.4]]}}}})",
        lon, lon);
  };
  const std::string path = geojson({road(179.99), road(-179.99)});
  const auto read = [&](const std::string& extent) {
    return read_road_network({path}, {.crs = "", .layer = "", .extent = extent}, RoadRules(),
                             *UtmZone::from_epsg(32760));
  };
  EXPECT_EQ(code_of([&] { read(""); }), "roads-around-the-earth");
  EXPECT_THAT(message_of([&] { read(""); }), HasSubstr("from longitude -179.99 to 179.99"));
  EXPECT_EQ(read("179.5,-17,-179.5,-16").lines.size(), 2U);
}

TEST_F(RoadLayers, OfATownAcrossThe180thMeridianAskForTheExtentOfTheTown) {
  std::vector<std::string> roads;
  for (int i = 0; i < 40; ++i) {
    const double lon = 179.99 + 0.0005 * i;
    roads.push_back(fmt::format(
        R"({{"type":"Feature","properties":{{}},"geometry":{{"type":"LineString","coordinates":[[{0},-16.5],[{0},-16.49]]}}}})",
        lon > 180.0 ? lon - 360.0 : lon));
  }
  const std::string path = geojson(roads);
  const auto read = [&] { read_road_network({path}, {}, RoadRules(), *UtmZone::from_epsg(32760)); };
  EXPECT_EQ(code_of(read), "roads-around-the-earth");
  EXPECT_THAT(message_of(read), HasSubstr("--extent 179.9"));
}

TEST_F(RoadLayers, OfDegreesThatAreDeclaredAsMetresAreRefused) {
  const std::string road = feature(R"("highway":"primary")", at(-50, -50), at(50, 50));
  for (const char* crs : {"EPSG:32637", "EPSG:3857", "EPSG:2263"}) {
    const std::string path = geojson({road});
    VectorOptions options;
    options.crs = crs;
    EXPECT_EQ(code_of([&] { centre_of_roads({path}, options); }), "degrees-as-metres") << crs;
    EXPECT_EQ(code_of([&] { read_road_network({path}, options, RoadRules(), kZone); }), "degrees-as-metres") << crs;
    options.extent = testing::extent_around_centre(100);
    EXPECT_THAT(message_of([&] { read_road_network({path}, options, RoadRules(), kZone); }),
                HasSubstr("give --crs EPSG:4326"));
  }
}

TEST_F(RoadLayers, WithEastingAndNorthingSwappedAreRefused) {
  const std::string path = geojson({R"({"type":"Feature","properties":{},"geometry":{"type":"LineString",)"
                                    R"("coordinates":[[4200000,400000],[4200100,400100]]}})"});
  VectorOptions options;
  options.crs = "EPSG:32637";
  EXPECT_EQ(code_of([&] { centre_of_roads({path}, options); }), "axes-swapped");
  EXPECT_EQ(code_of([&] { read_road_network({path}, options, RoadRules(), kZone); }), "axes-swapped");
}

TEST_F(RoadLayers, OfAShapefileMayHaveTheirReferenceSystemInWkt2) {
  require_gdal();
  const std::string path = (folder / "roads.shp").string();
  {
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("ESRI Shapefile");
    const DatasetPtr file(driver->Create(path.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    OGRLayer* layer = file->CreateLayer("roads", nullptr, wkbLineString);
    OGRLineString line;
    line.addPoint(400'000, 4'200'000);
    line.addPoint(400'100, 4'200'100);
    OGRFeature road(layer->GetLayerDefn());
    road.SetGeometry(&line);
    ASSERT_EQ(layer->CreateFeature(&road), OGRERR_NONE);
  }
  EXPECT_EQ(code_of([&] { centre_of_roads({path}, {}); }), "roads-without-georeference");
  char* wkt = nullptr;
  const char* const options[] = {"FORMAT=WKT2_2019", nullptr};
  utm_reference(kZone).exportToWkt(&wkt, options);
  std::ofstream(folder / "roads.prj") << wkt;
  CPLFree(wkt);
  EXPECT_NEAR(centre_of_roads({path}, {}).lat_deg, kZone.unproject({400'050, 4'200'050}).lat_deg, 1e-6);
}

TEST_F(RoadLayers, OfAShapefileWhoseAttributesAreOfAnotherSaveAreRefused) {
  require_gdal();
  GDALDriver& driver = *GetGDALDriverManager()->GetDriverByName("ESRI Shapefile");
  const auto save = [&](const std::string& name, const std::vector<std::string>& roads) {
    const DatasetPtr from = open_dataset(geojson(roads), GDAL_OF_VECTOR);
    std::string path = (folder / (name + ".shp")).string();
    const DatasetPtr closed(driver.CreateCopy(path.c_str(), from.get(), FALSE, nullptr, nullptr, nullptr));
    return path;
  };
  save("before", {road(0, 0)});
  const std::string now = save("now", {road(0, 0), road(50, 0), road(100, 0)});
  const auto lines = [&] { return read_road_network({now}, {}, RoadRules(), kZone).lines.size(); };
  EXPECT_EQ(lines(), 3U);
  std::filesystem::copy_file(folder / "before.dbf", folder / "now.dbf",
                             std::filesystem::copy_options::overwrite_existing);
  EXPECT_EQ(code_of(lines), "roads-unreadable");
  EXPECT_THAT(message_of(lines), HasSubstr("now.shx holds 3 shapes"));
  std::filesystem::remove(folder / "now.dbf");
  EXPECT_EQ(lines(), 3U) << "without attributes all are drawn";
}

TEST_F(RoadLayers, OfAGeoPackageThatLeavesTheirReferenceSystemOpenNeedOne) {
  const std::string file = street();
  {
    const DatasetPtr open = create_package();
    OGRLayer* layer = open->CreateLayer("roads", nullptr, wkbLineString);
    OGRFeature road(layer->GetLayerDefn());
    road.SetGeometry(
        OGRFeatureUniquePtr(open_dataset(file, GDAL_OF_VECTOR)->GetLayer(0)->GetNextFeature())->GetGeometryRef());
    ASSERT_EQ(layer->CreateFeature(&road), OGRERR_NONE);
  }
  EXPECT_EQ(code_of([&] { centre_of_roads({package()}, {}); }), "roads-without-georeference");
  const VectorOptions options{.crs = "EPSG:4326", .layer = "", .extent = ""};
  EXPECT_NEAR(centre_of_roads({package()}, options).lat_deg, kZone.unproject(kCentre).lat_deg, 1e-6);
}

TEST_F(RoadLayers, AnEmptyFileIsCalledEmptyAndBesideOthersItCostsNothing) {
  const std::string empty = (folder / "empty.geojson").string();
  std::ofstream(empty) << R"({"type":"FeatureCollection","features":[]})";
  EXPECT_THAT(message_of([&] { read_road_network({empty}, {}, RoadRules(), kZone); }), HasSubstr("it is empty"));
  EXPECT_THAT(message_of([&] { centre_of_roads({empty}, {}); }), HasSubstr("it is empty"));
  const std::string roads = street();
  EXPECT_EQ(read_road_network({empty, roads}, {}, RoadRules(), kZone).lines.size(), 1U);
  EXPECT_NEAR(kZone.project(centre_of_roads({empty, roads}, {})).east_m, kCentre.east_m, 1.0);
}

TEST_F(RoadLayers, ALayerIsTakenFromThoseFilesOfAFolderThatHaveIt) {
  const std::string roads = street();
  const std::string rivers = (folder / "rivers.geojson").string();
  std::filesystem::copy_file(roads, rivers);
  VectorOptions options;
  options.layer = "roads";
  EXPECT_EQ(read_road_network({rivers, roads}, options, RoadRules(), kZone).lines.size(), 1U);
  EXPECT_NEAR(kZone.project(centre_of_roads({rivers, roads}, options)).east_m, kCentre.east_m, 1.0);
}

TEST_F(RoadLayers, TablesWithoutGeometriesBesideTheRoadsAreNoConcern) {
  {
    const DatasetPtr to = create_package();
    to->CreateLayer("layer_styles", nullptr, wkbNone, nullptr);
    copy_layer(street(), *to);
  }
  EXPECT_EQ(read_road_network({package()}, {}, RoadRules(), kZone).lines.size(), 1U);
}

TEST_F(RoadLayers, TablesThatGdalCannotReadBesideThemAreNoConcern) {
  {
    const DatasetPtr to = create_package();
    copy_layer(street(), *to);
    to->ExecuteSQL("CREATE TABLE keys (id TEXT PRIMARY KEY) WITHOUT ROWID", nullptr, nullptr);
  }
  for (const char* layer : {"", "roads"}) {
    const VectorOptions options{.crs = "", .layer = layer, .extent = ""};
    EXPECT_EQ(read_road_network({package()}, options, RoadRules(), kZone).lines.size(), 1U) << layer;
  }
}

TEST_F(RoadLayers, TheCentreIsThatOfTheLinesWhateverAreasAndPointsLieBesideThem) {
  const auto another = [&](const std::string& name, const std::string& geometry) {
    std::ofstream(folder / name) << R"({"type":"Feature","properties":{},"geometry":)" + geometry + "}";
    return std::string(folder / name);
  };
  const std::string roads = street();
  const std::string countries =
      another("countries.geojson", R"({"type":"Polygon","coordinates":[[[-180,-80],[180,-80],[180,80],[-180,-80]]]})");
  const std::string points = another("points.geojson", R"({"type":"Point","coordinates":[7,50]})");
  {
    const DatasetPtr to = create_package();
    for (const std::string& from : {countries, points, roads}) copy_layer(from, *to);
  }
  for (const std::vector<std::string>& source : {std::vector{package()}, {countries, points, roads}}) {
    EXPECT_NEAR(kZone.project(centre_of_roads(source, {})).east_m, kCentre.east_m, 1.0) << source.front();
  }
  EXPECT_NEAR(centre_of_roads({points}, {}).lon_deg, 7.0, 0.01) << "where there is nothing else";
}

TEST_F(RoadLayers, AloneAreTheGroundThatWasSeenWhateverPointsAndAreasShareTheirLayer) {
  const std::string beside[] = {R"({"type":"Point","coordinates":[9,9]})",
                                R"({"type":"Polygon","coordinates":[[[9,9],[9.1,9],[9.1,9.1],[9,9]]]})",
                                R"({"type":"LineString","coordinates":[[9,9],[9,9]]})"};
  for (const char* properties : {R"("highway":"primary")", R"("name":"Yol")"}) {
    std::vector<std::string> features{feature(properties, at(-100, -100), at(100, 100))};
    for (const std::string& geometry : beside) {
      features.push_back(
          fmt::format(R"({{"type":"Feature","properties":{{{}}},"geometry":{}}})", properties, geometry));
    }
    const std::string path = geojson(features);
    EXPECT_NEAR(kZone.project(centre_of_roads({path}, {})).east_m, kCentre.east_m, 1.0);
    const RoadNetwork network = read_road_network({path}, {}, RoadRules(), kZone);
    ASSERT_EQ(network.covered.size(), 1U);
    EXPECT_NEAR(network.covered.front().box().width_m(), 200.0, 10.0) << properties;
    EXPECT_EQ(network.lines.size(), 1U);
    EXPECT_EQ(network.left_out, 3);
  }
}

TEST_F(RoadLayers, TheCentreIsWhereTheyAreWhateverAGeoPackageStates) {
  copy_layer(street(), *create_package());
  {
    const DatasetPtr stale(GDALDataset::Open(package().c_str(), GDAL_OF_VECTOR | GDAL_OF_UPDATE));
    stale->ExecuteSQL("UPDATE gpkg_contents SET min_x = -180, min_y = -90, max_x = 180, max_y = 90", nullptr, nullptr);
  }
  EXPECT_NEAR(kZone.project(centre_of_roads({package()}, {})).east_m, kCentre.east_m, 1.0);
}

}  // namespace
}  // namespace roadfix
