#include "tiles/world/real_streets.hpp"

#include <gmock/gmock.h>
#include <ogrsf_frmts.h>

#include "tests/support/code_of.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tiles/sources/gdal_session.hpp"

namespace roadfix::world {
namespace {

using ::testing::ElementsAre;
using ::testing::Field;

constexpr GridPoint kNorthWest{400000.0, 4200300.0};
const UtmZone kZone = *UtmZone::from_epsg(32637);
const Placement kPlacement{kZone, 1.0, 400, 300, kNorthWest};

class RealStreets : public ::testing::Test {
 protected:
  RealStreets() {
    require_gdal();
    file.reset(GetGDALDriverManager()->GetDriverByName("GPKG")->Create(path.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  }

  /// A layer of one feature.
  void add(const char* name, const char* road_class, const std::string& wkt) {
    OGRSpatialReference plane = utm_reference(kZone);
    OGRLayer* layer = file->CreateLayer(name, &plane, wkbUnknown);
    OGRFieldDefn field("highway", OFTString);
    if (road_class != nullptr) layer->CreateField(&field);
    OGRGeometry* geometry = nullptr;
    OGRGeometryFactory::createFromWkt(wkt.c_str(), nullptr, &geometry);
    OGRFeature feature(layer->GetLayerDefn());
    if (road_class != nullptr) feature.SetField("highway", road_class);
    feature.SetGeometryDirectly(geometry);
    ASSERT_EQ(layer->CreateFeature(&feature), OGRERR_NONE);
  }

  std::vector<Street> streets() {
    file.reset();
    return read_streets(path, kPlacement);
  }

  roadfix::testing::TemporaryFolder folder;
  std::string path = (folder / "town.gpkg").string();
  DatasetPtr file;
};

TEST_F(RealStreets, LieOnThePlanWithTheirClassAndWidth) {
  add("roads", "primary", "MULTILINESTRING((400010 4200290,400110 4200290),(400010 4200100,400390 4200100))");
  const std::vector<Street> result = streets();
  ASSERT_EQ(result.size(), 2U);
  for (const Street& street : result) {
    EXPECT_EQ(street.road_class, "primary");
    EXPECT_EQ(street.width_m, 10.0);
  }
  EXPECT_NEAR(cv::norm(result[0].line[0] - PlanPoint(10.0, 10.0)), 0.0, 1e-6);
  EXPECT_NEAR(cv::norm(result[1].line[1] - PlanPoint(390.0, 200.0)), 0.0, 1e-6);
}

TEST_F(RealStreets, RiversBesideClassifiedRoadsAreNone) {
  add("rivers", nullptr, "LINESTRING(400010 4200200,400390 4200210)");
  add("roads", "service", "LINESTRING(400010 4200100,400390 4200100)");
  EXPECT_THAT(streets(), ElementsAre(Field(&Street::road_class, "service")));
}

TEST_F(RealStreets, WithoutClassesAreRoads) {
  add("lines", nullptr, "LINESTRING(400010 4200200,400390 4200210)");
  EXPECT_THAT(streets(), ElementsAre(Field(&Street::road_class, "road")));
}

TEST_F(RealStreets, BesideThePictureAreLeftOutAndAloneRefused) {
  add("far", "primary", "LINESTRING(410000 4200000,410100 4200000)");
  EXPECT_EQ(roadfix::testing::code_of([&] { streets(); }), "world-without-roads");
}

}  // namespace
}  // namespace roadfix::world
