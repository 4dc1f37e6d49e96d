#include "tiles/roads/poly_file.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "tests/support/code_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roadfix {
namespace {

using testing::code_of;
using ::testing::HasSubstr;
using testing::message_of;

class PolyFile : public ::testing::Test {
 protected:
  std::string file(const std::string& text) {
    std::ofstream(folder / "land.poly") << text;
    return folder / "land.poly";
  }
  testing::TemporaryFolder folder;
};

TEST_F(PolyFile, IsKnownByItsName) {
  EXPECT_TRUE(is_poly_file("a/land.POLY"));
  EXPECT_FALSE(is_poly_file("land.geojson"));
}

TEST_F(PolyFile, HoldsRingsAndTheHolesInThem) {
  const auto polygons =
      read_poly_file(file("land\r\n1\r\n\t9.0E+00\t4.7E+01\r\n 10 47\r\n 10 48\r\n 9 48\r\n 9 47\r\nEND\r\n"
                          "!2\n 9.2 47.2\n 9.4 47.2\n 9.4 47.4\nEND\n\nisland\n -20 -1\n -19 -1\n -19 0\nEND\nEND\n"));
  ASSERT_EQ(polygons->getNumGeometries(), 2);
  const OGRPolygon& land = *polygons->getGeometryRef(0);
  EXPECT_EQ(land.getNumInteriorRings(), 1);
  EXPECT_NEAR(land.get_Area(), 1.0 - 0.02, 1e-9);
  const OGRPolygon& island = *polygons->getGeometryRef(1);
  EXPECT_EQ(island.getNumInteriorRings(), 0);
  EXPECT_NEAR(island.get_Area(), 0.5, 1e-9);
}

TEST_F(PolyFile, ThatCannotBeReadSaysInWhichLine) {
  EXPECT_EQ(code_of([&] { read_poly_file(folder / "none.poly"); }), "file-not-found");
  EXPECT_THAT(message_of([&] { read_poly_file(file("land\n1\n 9 47\n east north\nEND\n")); }),
              HasSubstr("line 4: 'east north' is no longitude and latitude"));
  EXPECT_THAT(message_of([&] { read_poly_file(file("land\n1\n 47 9\n 470 9\n 47 10\nEND\n")); }), HasSubstr("line 4"));
  EXPECT_THAT(message_of([&] { read_poly_file(file("land\n1\n 9 47\n 9 48\nEND\n")); }), HasSubstr("less than three"));
  EXPECT_THAT(message_of([&] { read_poly_file(file("land\n1\n 9 47\n 9 48\n 10 48\n")); }), HasSubstr("cut off"));
}

}  // namespace
}  // namespace roadfix
