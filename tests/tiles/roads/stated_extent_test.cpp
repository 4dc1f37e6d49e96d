// The ground that roads are said to cover.
#include <gmock/gmock.h>
#include <ogrsf_frmts.h>

#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "tests/support/code_of.hpp"
#include "tests/tiles/roads/vector_roads_fixture.hpp"
#include "tiles/roads/stated_extent.hpp"
#include "tiles/sources/gdal_session.hpp"

namespace roadfix {
namespace {

using ::testing::AllOf;
using testing::at;
using testing::code_of;
using testing::degrees;
using testing::extent_around_centre;
using testing::feature;
using ::testing::HasSubstr;
using testing::kCentre;
using testing::kZone;
using testing::message_of;
using ::testing::Not;

class StatedExtent : public testing::VectorRoads {
 protected:
  static void write_extent(const std::string& path, OGRSpatialReference* crs,
                           const std::vector<std::string>& polygons) {
    require_gdal();
    const char* driver = path.ends_with(".shp") ? "ESRI Shapefile" : "GPKG";
    const DatasetPtr file(
        GetGDALDriverManager()->GetDriverByName(driver)->Create(path.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    const auto type = path.ends_with(".shp") ? wkbPolygon : wkbUnknown;
    OGRLayer* layer = file->CreateLayer("drawn", crs, type);
    for (const std::string& wkt : polygons) {
      OGRGeometry* geometry = nullptr;
      OGRGeometryFactory::createFromWkt(wkt.c_str(), nullptr, &geometry);
      OGRFeature feature(layer->GetLayerDefn());
      feature.SetGeometryDirectly(geometry);
      ASSERT_EQ(layer->CreateFeature(&feature), OGRERR_NONE);
    }
  }
  OGRSpatialReference plane_ = utm_reference(kZone);
};

TEST_F(StatedExtent, GroundBesideTheExtentIsUnobserved) {
  const std::string path = geojson({feature(R"("highway":"primary")", at(-50, -50), at(50, 50))});
  const CellArray own = cells(*open_road_vectors({path}, {}, RoadRules(), kZone, 2.0));
  EXPECT_NEAR(static_cast<double>(own.observed_count()), 2500.0, 110.0);
  VectorOptions options;
  options.extent = extent_around_centre(100);
  const CellArray stated = cells(*open_road_vectors({path}, options, RoadRules(), kZone, 2.0));
  EXPECT_NEAR(static_cast<double>(stated.observed_count()), 10000.0, 300.0);
}

TEST_F(StatedExtent, OfAnExtentFileWhatIsInAPolygonAndNotInItsHolesIsKnown) {
  const std::string path = geojson({feature(R"("highway":"primary")", at(-150, 0), at(150, 0))});
  const auto ring = [](double half_m) {
    return fmt::format("({0} {2},{1} {2},{1} {3},{0} {3},{0} {2})", kCentre.east_m - half_m, kCentre.east_m + half_m,
                       kCentre.north_m - half_m, kCentre.north_m + half_m);
  };
  const std::string known = (folder / "known.gpkg").string();
  write_extent(known, &plane_, {"POLYGON EMPTY", fmt::format("MULTIPOLYGON(({},{}))", ring(100), ring(50))});
  VectorOptions options;
  options.extent = known;
  const CellArray result = cells(*open_road_vectors({path}, options, RoadRules(), kZone, 2.0));
  EXPECT_EQ(result.observed_count(), 100U * 100U - 50U * 50U);
  EXPECT_TRUE(is_observed(result.at(60, 100)));
  EXPECT_FALSE(is_observed(result.at(100, 100))) << "in the hole";
  EXPECT_FALSE(is_observed(result.at(40, 100))) << "outside";
}

TEST_F(StatedExtent, ThatHoldsNoneOfTheRoadsIsRefusedAndSaidWhereTheyLie) {
  const std::string path = geojson({road(0, 0), road(300, 0)});
  const LatLon place = kZone.unproject(kCentre);
  const auto refusal = [&](double lon, double lat) {
    const VectorOptions options{
        .crs = "", .layer = "", .extent = fmt::format("{},{},{},{}", lon, lat, lon + 0.02, lat + 0.02)};
    EXPECT_EQ(code_of([&] { open_road_vectors({path}, options, RoadRules(), kZone, 2.0); }), "source-without-roads");
    return message_of([&] { open_road_vectors({path}, options, RoadRules(), kZone, 2.0); });
  };
  EXPECT_THAT(refusal(place.lon_deg + 1.0, place.lat_deg),
              AllOf(HasSubstr("none of its 2 roads lies in --extent 38"), HasSubstr("they lie in 37.8619,37.9420,"),
                    Not(HasSubstr("swapped"))));
  EXPECT_THAT(refusal(place.lat_deg - 0.01, place.lon_deg - 0.01), HasSubstr("latitude and longitude may be swapped"));
  EXPECT_THAT(refusal(-60.0, 38.0), HasSubstr("they lie in 37.8619,37.9420,")) << "on the other side of the Earth";
}

TEST_F(StatedExtent, MayHaveArcs) {
  const std::string path = geojson({feature(R"("highway":"primary")", at(-150, 0), at(150, 0))});
  VectorOptions options;
  options.extent = folder / "circle.gpkg";
  write_extent(options.extent, &plane_,
               {fmt::format("CURVEPOLYGON(CIRCULARSTRING({0} {1},{2} {3},{4} {1},{2} {5},{0} {1}))",
                            kCentre.east_m - 100, kCentre.north_m, kCentre.east_m, kCentre.north_m + 100,
                            kCentre.east_m + 100, kCentre.north_m - 100)});
  const CellArray result = cells(*open_road_vectors({path}, options, RoadRules(), kZone, 2.0));
  EXPECT_NEAR(static_cast<double>(result.observed_count()), std::numbers::pi * 50 * 50, 30.0);
}

TEST_F(StatedExtent, WithoutGroundOrReferenceSystemIsRefusedForWhatItIs) {
  VectorOptions options{.crs = "EPSG:32637", .layer = "", .extent = folder / "drawn.shp"};
  const auto refusal = [&](OGRSpatialReference* crs, const std::vector<std::string>& polygons) {
    write_extent(options.extent, crs, polygons);
    return message_of([&] { centre_of_roads({"roads.gpkg"}, options); });
  };
  EXPECT_THAT(refusal(&plane_, {}), HasSubstr("holds no polygon"));
  EXPECT_THAT(refusal(nullptr, {"POLYGON((0 0,1 0,1 1,0 0))"}), HasSubstr("layer 'drawn' has no reference system"));
}

TEST_F(StatedExtent, OfTooFewNumbersIsNoFileThatIsMissing) {
  for (const char* extent : {"38.26,37.75,38.28", "38.26 37.75 38.28 37.77", "38,26,37,75,38,28,37,77"}) {
    EXPECT_THAT(message_of([&] { centre_of_roads({"roads.gpkg"}, {.crs = "", .layer = "", .extent = extent}); }),
                HasSubstr("write west,south,east,north"))
        << extent;
  }
}

TEST_F(StatedExtent, CrossesGreenwichInLongitudesFrom0To360) {
  const std::optional<GeoBox> box = box_in_degrees("350,45,10,46");
  ASSERT_TRUE(box);
  EXPECT_EQ(box->south_west.lon_deg, 350.0);
  EXPECT_EQ(box->north_east.lon_deg, 370.0);
  const UtmZone zone = UtmZone::from_epsg(32631).value();
  const GridBox ground = read_extent("359.99,45,0.01,45.01", zone).front().box();
  const GridBox same = read_extent("-0.01,45,0.01,45.01", zone).front().box();
  EXPECT_NEAR(distance_m(ground.min, same.min), 0.0, 0.01);
  EXPECT_NEAR(distance_m(ground.max, same.max), 0.0, 0.01);
}

TEST_F(StatedExtent, OfNumbersThatAreNoPlacesOnEarthIsRefusedAsSuch) {
  for (const char* extent : {"0x26,37,39,38", "-inf,0,inf,1", "nan,0,1,1", "-1e9,0,1e9,1", "0,-91,1,0", "1,0,1,1"}) {
    EXPECT_THAT(message_of([&] { centre_of_roads({"roads.gpkg"}, {.crs = "", .layer = "", .extent = extent}); }),
                HasSubstr("write west,south,east,north"))
        << extent;
  }
}

TEST_F(StatedExtent, MayCoverThePolygonsOfAnOsmosisFilter) {
  const std::string path = geojson({feature(R"("highway":"primary")", at(-150, 0), at(150, 0))});
  VectorOptions options;
  options.extent = folder / "known.poly";
  std::ofstream file(options.extent);
  const auto square = [&](const char* name, GridPoint centre, double half_m) {
    file << name << '\n';
    for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
      const LatLon corner = kZone.unproject({centre.east_m + x * half_m, centre.north_m + y * half_m});
      file << fmt::format("   {:.9E}   {:.9E}\n", corner.lon_deg, corner.lat_deg);
    }
    file << "END\n";
  };
  file << "known\n";
  square("1", at(-60, 0), 50);
  square("!2", at(-60, 0), 20);
  square("3", at(60, 0), 50);
  file << "END\n";
  file.close();
  const CellArray result = cells(*open_road_vectors({path}, options, RoadRules(), kZone, 2.0));
  EXPECT_NEAR(static_cast<double>(result.observed_count()), 2.0 * 50 * 50 - 20 * 20, 60.0);
  EXPECT_TRUE(is_observed(result.at(50, 100)));
  EXPECT_FALSE(is_observed(result.at(70, 100))) << "in the hole";
  EXPECT_FALSE(is_observed(result.at(100, 100))) << "between the squares";
  EXPECT_NEAR(kZone.project(centre_of_roads({path}, options)).east_m, kCentre.east_m, 1.0);
}

TEST_F(StatedExtent, AnExtentOfFourCornersCoversTheGroundOfTheSameBoxOfDegrees) {
  // Along a parallel the middle of a side lies 280 m off its chord.
  const std::string path = geojson({feature(R"("highway":"primary")", at(-150, 0), at(150, 0))});
  const LatLon centre = kZone.unproject(kCentre);
  const auto covered_by = [&](const std::string& extent) {
    VectorOptions options;
    options.extent = extent;
    return cells(*open_road_vectors({path}, options, RoadRules(), kZone, 2.0));
  };
  const double south = centre.lat_deg + 20.0 / 111e3;
  const double west = centre.lon_deg - 0.8;
  const double east = centre.lon_deg + 0.8;
  const std::string file = (folder / "box.geojson").string();
  std::ofstream(file) << fmt::format(
      R"({{"type":"Polygon","coordinates":[[[{0},{1}],[{2},{1}],[{2},{3}],[{0},{3}],[{0},{1}]]]}})", west, south, east,
      south + 1.0);
  const CellArray box = covered_by(fmt::format("{},{},{},{}", west, south, east, south + 1.0));
  EXPECT_GT(box.observed_count(), 1000U);
  EXPECT_LT(box.observed_count(), 39000U);
  const CellArray polygon = covered_by(file);
  int different = 0;
  for (int row = 0; row < box.rows(); ++row) {
    for (int col = 0; col < box.cols(); ++col) {
      if (is_observed(polygon.at(col, row)) != is_observed(box.at(col, row))) ++different;
    }
  }
  EXPECT_LT(different, kWindow.cols) << "less than a row of cells";
}

TEST_F(StatedExtent, TheCentreIsThatOfTheGroundThatIsAskedFor) {
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

TEST_F(StatedExtent, AnExtentMayCrossTheAntimeridian) {
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

TEST_F(StatedExtent, MakesTheRoadsOthersWhereItsPolygonHasChanged) {
  const std::string path = geojson({feature(R"("highway":"primary")", at(-150, 0), at(150, 0))});
  VectorOptions options;
  options.extent = (folder / "seen.geojson").string();
  const auto fingerprint_within = [&](GridPoint corner) {
    std::ofstream(options.extent) << R"({"type":"Polygon","coordinates":[[)" << degrees(at(-100, -100)) << ","
                                  << degrees(at(100, -100)) << "," << degrees(corner) << "," << degrees(at(-100, -100))
                                  << "]]}";
    return open_road_vectors({path}, options, RoadRules(), kZone, 2.0)->summary().fingerprint;
  };
  const std::string before = fingerprint_within(at(100, 100));
  EXPECT_NE(fingerprint_within(at(100, 120)), before);
}

}  // namespace
}  // namespace roadfix
