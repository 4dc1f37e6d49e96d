#include "tiles/sources/coordinate_limits.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <memory>

#include "tiles/sources/gdal_session.hpp"

namespace roadfix {
namespace {

bool holds(const char* crs, const char* wkt) {
  const OGRSpatialReference reference = parse_crs(crs);
  OGRGeometry* geometry = nullptr;
  EXPECT_EQ(OGRGeometryFactory::createFromWkt(wkt, nullptr, &geometry), OGRERR_NONE) << wkt;
  const std::unique_ptr<OGRGeometry> owned(geometry);
  return coordinate_limits(reference).hold(*geometry);
}

TEST(CoordinateLimits, AreThoseOfTheEarthInTheUnitsOfTheReferenceSystem) {
  for (const char* crs : {"EPSG:4326", "EPSG:4979"}) {
    EXPECT_TRUE(holds(crs, "LINESTRING(-180 -90,360 90)")) << "some go round the Earth eastwards";
    EXPECT_FALSE(holds(crs, "LINESTRING(38 37,38 91)"));
    EXPECT_FALSE(holds(crs, "LINESTRING(37 38,400000 4200000)"));
  }
  EXPECT_TRUE(holds("EPSG:4807", "LINESTRING(0 55,10 100)")) << "grads";
  EXPECT_FALSE(holds("EPSG:4807", "LINESTRING(0 55,10 101)"));
  EXPECT_TRUE(holds("EPSG:3857", "LINESTRING(0 0,20037508 -242528680)"));
  EXPECT_TRUE(holds("EPSG:2263", "LINESTRING(0 0,1000000 200000)"));
  EXPECT_FALSE(holds("EPSG:3857", "LINESTRING(0 0,0 1e30)"));
}

TEST(CoordinateLimits, CountForEveryPartOfAGeometryButNotForEmptyOnes) {
  EXPECT_TRUE(holds("EPSG:4326", "GEOMETRYCOLLECTION(POINT EMPTY,LINESTRING EMPTY,LINESTRING(38 37,39 37))"));
  EXPECT_FALSE(holds("EPSG:4326", "GEOMETRYCOLLECTION(LINESTRING(1 1,2 2),MULTILINESTRING((38 37,39 99)))"));
  EXPECT_FALSE(holds("EPSG:4326", "COMPOUNDCURVE((38 37,39 37),CIRCULARSTRING(39 37,39 99,38 38))"));
}

TEST(CoordinateLimits, HoldNothingThatIsNoNumber) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  OGRLineString line;
  line.addPoint(38.0, 37.0);
  line.addPoint(kNaN, 37.0);
  line.addPoint(39.0, 37.0);
  const CoordinateLimits limits = coordinate_limits(wgs84_reference());
  EXPECT_FALSE(limits.hold(line));
  OGREnvelope box;
  box.MinX = kNaN;
  box.MaxX = 39.0;
  box.MinY = box.MaxY = 37.0;
  EXPECT_FALSE(limits.hold(box));
}

}  // namespace
}  // namespace roadfix
