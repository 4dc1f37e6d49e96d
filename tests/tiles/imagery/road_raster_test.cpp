// Rasters that say themselves where roads are.
#include <gmock/gmock.h>

#include <memory>
#include <string>
#include <tuple>
#include <utility>

#include "tests/support/code_of.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/tiles/sources/place.hpp"
#include "tests/tiles/sources/test_raster.hpp"
#include "tiles/imagery/collar.hpp"
#include "tiles/imagery/raster_sources.hpp"
#include "tiles/imagery/road_values.hpp"
#include "tiles/sources/certainty.hpp"
#include "tiles/sources/exported_roads.hpp"
#include "tiles/sources/gdal_session.hpp"

namespace roadfix {
namespace {

using testing::kZone;
using testing::RasterSpec;
using testing::write_raster;

TEST(RoadRasterNote, IsGivenForPicturesInColourAndNotForDrawingsInGrey) {
  const testing::TemporaryFolder folder;
  const auto note = [&](int bands, const testing::PixelFunction& value) {
    return note_on_likely_picture(write_raster(folder / "a.tif", {.bands = bands}, value), {}, {});
  };
  const auto ground = [](int band, int col, int row) { return 60 + (col + row) % 64 + 30 * band; };
  const auto drawing = [](int, int col, int) { return col < 31 ? 255.0 : 0.0; };
  EXPECT_THAT(note(3, ground), ::testing::Optional(::testing::HasSubstr("without --as roads")));
  EXPECT_EQ(note(3, drawing), std::nullopt);
  EXPECT_EQ(note(1, ground), std::nullopt);
}

TEST(RoadRasterNote, IsGivenForColouredLinesAndForDarkOnesOnLightGround) {
  const testing::TemporaryFolder folder;
  const auto note = [&](const testing::RasterSpec& spec, double line, double ground) {
    const std::string path =
        write_raster(folder / "a.tif", spec, [=](int, int col, int) { return col % 16 == 3 ? line : ground; });
    return open_road_raster({path}, {}, kZone, 2.0)->summary().notes;
  };
  using ::testing::ElementsAre;
  using ::testing::HasSubstr;
  const testing::RasterSpec red_on_black{.palette = {{0, 0, 0, 255}, {255, 0, 0, 255}}};
  EXPECT_THAT(note(red_on_black, 1.0, 0.0), ElementsAre(HasSubstr("if colours stand for roads")));
  const testing::RasterSpec black_and_white{.palette = {{0, 0, 0, 255}, {255, 255, 255, 255}}};
  EXPECT_THAT(note(black_and_white, 1.0, 0.0), ::testing::IsEmpty());
  EXPECT_THAT(note(black_and_white, 0.0, 1.0), ElementsAre(HasSubstr("-scale 0 255 255 0")));
  EXPECT_THAT(note({}, 0.0, 1.0), ElementsAre(AllOf(HasSubstr("94 % of it is road"), HasSubstr("-scale 0 1 1 0"))));
  EXPECT_THAT(note({}, 1.0, 0.0), ::testing::IsEmpty());
}

class RoadRaster : public ::testing::Test {
 protected:
  CellArray cells(GDALDataType type, double road) {
    const RasterSpec spec{.type = type, .transform = {{400000.0, 1.0, 0.0, 4200064.0, 0.0, -1.0}}};
    const std::string path =
        write_raster(folder / "a.tif", spec, [road](int, int col, int) { return col < 31 ? road : 0.0; });
    const auto source = open_road_raster({path}, {}, kZone, 2.0);
    EXPECT_EQ(source->summary().kind, SourceKind::kRoadRaster);
    return source->read({2.0, {200000, -2100032}, 32, 32}, 1);
  }
  testing::TemporaryFolder folder;
};

TEST_F(RoadRaster, MasksOfAnyRangeCarryTheCertaintyOfDrawnRoads) {
  const Certainty certainty;
  for (const auto& [type, road] : {std::pair{GDT_Byte, 255.0}, {GDT_Byte, 1.0}, {GDT_UInt16, 65535.0}}) {
    const CellArray result = cells(type, road);
    EXPECT_EQ(result.at(14, 5), cell_from_probability(certainty.on_road));
    EXPECT_EQ(result.at(20, 5), cell_from_probability(certainty.elsewhere));
    EXPECT_NEAR(probability(result.at(15, 5)), certainty.probability(0.5), 0.005);
  }
}

TEST_F(RoadRaster, MasksOfZeroAndOneKeepTheirRangeBesideOthersButNotBesideGradedShares) {
  const auto west_of_both = [&](double min, double max) {
    const auto raster = [&](const char* name, double west_m, double elsewhere, double road) {
      return write_raster(folder / name, {.transform = {{west_m, 1.0, 0.0, 4200064.0, 0.0, -1.0}}},
                          [=](int, int col, int) { return col < 31 ? road : elsewhere; });
    };
    const std::string small = raster("small.tif", 400000.0, 0.0, 1.0);
    const std::string large = raster("large.tif", 400064.0, min, max);
    const auto source = open_road_raster({small, large}, {}, kZone, 2.0);
    const CellArray result = source->read({2.0, {200000, -2100032}, 64, 32}, 1);
    return std::pair{result.at(14, 5), result.at(46, 5)};
  };
  const Cell road = cell_from_probability(Certainty{}.on_road);
  EXPECT_EQ(west_of_both(0.0, 255.0), (std::pair{road, road}));
  const auto [faint, graded] = west_of_both(40.0, 255.0);
  EXPECT_LT(probability(faint), 0.05);
  EXPECT_EQ(graded, road);
}

TEST_F(RoadRaster, ValuesThatAreNoSharesAreRefused) {
  for (const auto& [type, value] : {std::pair{GDT_Float32, 100.0}, {GDT_Float32, -9999.0}, {GDT_Int16, -9999.0}}) {
    EXPECT_EQ(testing::code_of([&, t = type, v = value] { cells(t, v); }), "road-values-out-of-range") << value;
  }
  EXPECT_NO_THROW(cells(GDT_Float32, 1.04)) << "resampling overshoots";
}

TEST_F(RoadRaster, ValuesThatHardlySayAnythingGetANote) {
  const auto notes = [&](double road, double elsewhere, std::optional<double> nodata) {
    RasterSpec spec;
    spec.nodata = nodata;
    const std::string path =
        write_raster(folder / "b.tif", spec, [&](int, int col, int) { return col < 31 ? road : elsewhere; });
    return open_road_raster({path}, {}, kZone, 2.0)->summary().notes;
  };
  EXPECT_THAT(notes(255.0, 0.0, std::nullopt), ::testing::IsEmpty());
  EXPECT_THAT(notes(1.0, 0.0, std::nullopt), ::testing::IsEmpty());
  EXPECT_THAT(notes(255.0, 0.0, 0.0), ::testing::ElementsAre(::testing::HasSubstr("-unsetnodata")));
  EXPECT_THAT(notes(100.0, 0.0, std::nullopt),
              ::testing::ElementsAre(::testing::HasSubstr("no road is surer than 39 %")));
  EXPECT_THAT(notes(0.0, 0.0, std::nullopt), ::testing::ElementsAre(::testing::HasSubstr("becomes no road")));
  EXPECT_THAT(notes(2.0, 1.0, std::nullopt),
              ::testing::ElementsAre(::testing::AllOf(
                  ::testing::HasSubstr("its values are 1 and 2, as labels are, and count as 0.392 and 0.784 % road"),
                  ::testing::HasSubstr("gdal_translate -scale 1 2 0 255"))));
}

/// A raster of `ground` but for a square of `village` and a line of `road` across it, which lie between what is
/// sampled.
class SparseRoadRaster : public ::testing::Test {
 protected:
  std::unique_ptr<CellSource> open(GDALDataType type, double ground, double village, double road) {
    const RasterSpec spec{.width = 2048, .height = 2048, .type = type};
    const auto within = [](int place) { return place >= 68 && place < 128; };
    const std::string path = write_raster(folder / "sparse.tif", spec, [&](int, int col, int row) {
      if (!within(col) || !within(row)) return ground;
      return row >= 96 && row < 104 ? road : village;
    });
    return open_road_raster({path}, {}, kZone, 2.0);
  }
  static CellArray read(const CellSource& source) { return source.read({2.0, {200000, -2100032}, 64, 64}, 1); }
  testing::TemporaryFolder folder;
};

TEST_F(SparseRoadRaster, ItsRangeFollowsFromAllOfItsValues) {
  const Certainty certainty;
  for (const auto& [type, village, road] : {std::tuple{GDT_Byte, 20.0, 255.0},
                                            {GDT_UInt16, 300.0, 65535.0},
                                            {GDT_Byte, 0.0, 1.0},
                                            {GDT_Int32, 0.0, 255.0}}) {
    const CellArray cells = read(*open(type, 0.0, village, road));
    EXPECT_NEAR(probability(cells.at(40, 38)), certainty.probability(village / road), 0.005) << village;
    EXPECT_EQ(cells.at(40, 49), cell_from_probability(certainty.on_road)) << road;
  }
}

TEST_F(SparseRoadRaster, ValuesThatAreNoSharesAreRefusedWhereTheyAreMet) {
  for (const auto& [type, village] : {std::pair{GDT_Float32, 5.0}, {GDT_Float32, -9999.0}, {GDT_Int16, -9999.0}}) {
    const auto source = open(type, 0.0, village, 1.0);
    EXPECT_EQ(testing::code_of([&] { read(*source); }), "road-values-out-of-range") << village;
  }
}

TEST_F(SparseRoadRaster, ValuesThatMayMeanAnotherRangeGetANote) {
  const auto notes = [&](GDALDataType type, double ground, double village, double road) {
    return open(type, ground, village, road)->summary().notes;
  };
  using ::testing::ElementsAre;
  using ::testing::HasSubstr;
  EXPECT_THAT(notes(GDT_UInt16, 0.0, 0.0, 200.0), ElementsAre(HasSubstr("-ot Byte -scale 0 65535 0 255")));
  EXPECT_THAT(notes(GDT_UInt16, 0.0, 0.0, 255.0), ::testing::IsEmpty());
  EXPECT_THAT(notes(GDT_UInt16, 0.0, 0.0, 1.0), ::testing::IsEmpty());
  EXPECT_THAT(notes(GDT_Byte, 1.0, 0.0, 255.0), ::testing::Contains(HasSubstr("mark that as nodata")));
  EXPECT_THAT(notes(GDT_Byte, 0.0, 0.0, 255.0), ::testing::IsEmpty());
  EXPECT_THAT(notes(GDT_UInt16, 1.0, 1.0, 2.0), ElementsAre(HasSubstr("as labels are")));
}

TEST_F(RoadRaster, CopiesOfMapsAndExportsByOtherProgramsGetANote) {
  const auto notes = [&](const char* name, const std::string& text, double road) {
    const std::string path =
        write_raster(folder / "c.tif", {}, [road](int, int col, int) { return col < 31 ? road : 0.0; });
    open_dataset(path, GDAL_OF_RASTER | GDAL_OF_UPDATE)->SetMetadataItem(name, text.c_str());
    return open_road_raster({path}, {}, kZone, 2.0)->summary().notes;
  };
  const auto copied = ::testing::HasSubstr("another program copied it from a map");
  EXPECT_THAT(notes("IDENTIFIER", "road_probability", 254.0), ::testing::ElementsAre(copied));
  const std::string description(kExportedRoads);
  EXPECT_THAT(notes("TIFFTAG_IMAGEDESCRIPTION", description, 254.0), ::testing::ElementsAre(copied));
  EXPECT_THAT(notes("TIFFTAG_IMAGEDESCRIPTION", description, 100.0),
              ::testing::ElementsAre(::testing::HasSubstr("its largest value is 100 of 254"), copied))
      << "rescaled";
}

TEST_F(RoadRaster, FloatsAreProbabilitiesAsTheyAre) {
  const CellArray result = cells(GDT_Float32, 0.6);
  EXPECT_NEAR(probability(result.at(14, 5)), 0.6, 0.004);
  EXPECT_NEAR(probability(result.at(15, 5)), 0.3, 0.004);
  EXPECT_EQ(result.at(20, 5), kNoRoad);
}

}  // namespace
}  // namespace roadfix
