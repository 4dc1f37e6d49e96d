// Roads that a detector sees in imagery.
#include <cpl_string.h>
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/geodesy/utm.hpp"
#include "tests/support/code_of.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/tiles/sources/place.hpp"
#include "tests/tiles/sources/test_raster.hpp"
#include "tiles/imagery/raster_sources.hpp"
#include "tiles/imagery/road_values.hpp"
#include "tiles/sources/gdal_session.hpp"

namespace roadfix {
namespace {

using testing::kZone;
using testing::RasterSpec;
using testing::write_raster;

/// Brightness blurred over 9 x 9 cells: looks as far beyond a cell as it says, and no further.
class BlurDetector final : public RoadDetector {
 public:
  CellArray detect(const GroundImage& image, double cell_m, std::uint64_t, const std::stop_token&) const override {
    const int step = static_cast<int>(std::lround(cell_m / image.gsd_m));
    cv::Mat cells;
    cv::resize(image.pixels, cells, {image.pixels.cols / step, image.pixels.rows / step}, 0, 0, cv::INTER_AREA);
    cv::blur(cells, cells, {9, 9}, {-1, -1}, cv::BORDER_REPLICATE);
    const cv::Mat observed = observed_cells(image, cell_m);
    CellArray result(cells.cols, cells.rows);
    for (int row = 0; row < cells.rows; ++row) {
      for (int col = 0; col < cells.cols; ++col) {
        if (observed.at<std::uint8_t>(row, col) != 0) result.at(col, row) = std::min(kRoad, cells.at<Cell>(row, col));
      }
    }
    return result;
  }
  double preferred_gsd_m() const override { return 1.0; }
  double halo_m() const override { return 8.0; }
  std::string name() const override { return "blur"; }
  std::string settings() const override { return {}; }
};

TEST(DetectionGsd, DividesTheCellByAPowerOfTwoNearestToWhatIsNeeded) {
  EXPECT_EQ(detection_gsd_m(2.0, 0.5, 0.5), 0.5);
  EXPECT_EQ(detection_gsd_m(2.0, 0.5, 0.506), 0.5);
  EXPECT_EQ(detection_gsd_m(2.0, 0.5, 0.1), 0.5);   // not finer than the detector wants
  EXPECT_EQ(detection_gsd_m(2.0, 0.5, 0.9), 1.0);   // not finer than the imagery has
  EXPECT_EQ(detection_gsd_m(2.0, 0.5, 30.0), 2.0);  // never coarser than a cell
}

TEST(Imagery, BlocksJoinWithoutASeam) {
  const testing::TemporaryFolder folder;
  const RasterSpec spec{.width = 400, .height = 400, .transform = {{400003.3, 1.0, 0.0, 4200404.7, 0.0, -1.0}}};
  const std::string path =
      write_raster(folder / "a.tif", spec, [](int, int col, int row) { return (col * 3 + row * 5) % 240; });
  const BlurDetector detector;
  const auto source = open_imagery({path}, {}, kZone, 2.0, detector);
  const GridGeometry whole = GridGeometry::covering(source->extent(), 2.0);
  const CellArray expected = source->read(whole, 1);
  CellArray joined(whole.cols, whole.rows);
  constexpr int kSide = 64;
  for (int row = 0; row < whole.rows; row += kSide) {
    for (int col = 0; col < whole.cols; col += kSide) {
      const GridGeometry block{2.0, {whole.origin.col + col, whole.origin.row + row}, kSide, kSide};
      paste(source->read(block, 1), joined, col, row);
    }
  }
  ASSERT_GT(expected.observed_count(), 39000U);
  EXPECT_EQ(joined.observed_count(), expected.observed_count());
  for (int row = 0; row < whole.rows; ++row) {
    for (int col = 0; col < whole.cols; ++col) {
      // The pixels may differ by one: coordinates are interpolated from other nodes.
      ASSERT_NEAR(joined.at(col, row), expected.at(col, row), 1) << col << ' ' << row;
    }
  }
}

TEST(Imagery, NodataIsUnobservedNeverNoRoad) {
  const testing::TemporaryFolder folder;
  const RasterSpec spec{
      .width = 256, .height = 256, .transform = {{400000.0, 1.0, 0.0, 4200256.0, 0.0, -1.0}}, .nodata = 0.0};
  const std::string path = write_raster(
      folder / "a.tif", spec, [](int, int col, int row) { return col < 100 ? 0.0 : 180.0 + (col + row) % 8; });
  const BlurDetector detector;
  const auto source = open_imagery({path}, {}, kZone, 2.0, detector);
  const CellArray cells = source->read(GridGeometry::covering(source->extent(), 2.0), 1);
  for (int row = 0; row < cells.rows(); ++row) {
    for (int col = 0; col < cells.cols(); ++col) ASSERT_EQ(is_observed(cells.at(col, row)), col >= 50) << col;
  }
}

TEST(Imagery, OfPixelsWiderThanRoadsIsRefused) {
  const testing::TemporaryFolder folder;
  const BlurDetector detector;
  for (const double gsd_m : {4.9, 5.1, 60.0}) {
    const RasterSpec spec{.transform = {{400000.0, gsd_m, 0.0, 4200064.0, 0.0, -gsd_m}}};
    const std::string path = write_raster(folder / "a.tif", spec, [](int, int col, int) { return 100 + col; });
    EXPECT_EQ(testing::code_of([&] { open_imagery({path}, {}, kZone, 4.0, detector); }),
              gsd_m < 5.0 ? "no error" : "imagery-too-coarse");
  }
}

TEST(Imagery, DoesNotShowAPaintedCollarWhateverItsColourAndSaysNothingOfIt) {
  const testing::TemporaryFolder folder;
  const BlurDetector detector;
  const RasterSpec spec{.width = 256, .height = 256, .transform = {{400000.0, 1.0, 0.0, 4200256.0, 0.0, -1.0}}};
  for (const double collar : {0.0, 128.0, 255.0}) {
    const std::string path = write_raster(folder / "a.tif", spec, [collar](int, int col, int row) {
      return col < 64 ? collar : 60.0 + (col + row) % 100;
    });
    const auto source = open_imagery({path}, {}, kZone, 2.0, detector);
    EXPECT_TRUE(source->summary().notes.empty());
    const CellArray cells = source->read(GridGeometry::covering(source->extent(), 2.0), 1);
    EXPECT_FALSE(is_observed(cells.at(31, 60))) << collar;
    EXPECT_TRUE(is_observed(cells.at(34, 60))) << collar;
  }
}

TEST(Imagery, OfManyBitsWithAnUnmarkedRimKeepsTheRangeOfTheGround) {
  const testing::TemporaryFolder folder;
  const BlurDetector detector;
  for (const auto& [type, rim] : {std::pair{GDT_Float32, -9999.0}, {GDT_UInt16, 0.0}, {GDT_UInt16, 65535.0}}) {
    const RasterSpec spec{
        .width = 256, .height = 256, .type = type, .transform = {{400000.0, 1.0, 0.0, 4200256.0, 0.0, -1.0}}};
    const std::string path = write_raster(folder / "a.tif", spec, [rim = rim](int, int col, int row) {
      return col < 64 ? rim : 600.0 + (col + row) % 100;
    });
    const auto source = open_imagery({path}, {}, kZone, 2.0, detector);
    EXPECT_THAT(source->summary().method, ::testing::HasSubstr("values 600..699")) << rim;
    const CellArray cells = source->read(GridGeometry::covering(source->extent(), 2.0), 1);
    EXPECT_FALSE(is_observed(cells.at(31, 60))) << rim;
    EXPECT_TRUE(is_observed(cells.at(34, 60))) << rim;
  }
}

TEST(Imagery, WithAnAlphaBandThatLooksLikeNearInfraredGetsANote) {
  const testing::TemporaryFolder folder;
  const BlurDetector detector;
  const auto notes = [&](const std::function<double(int col, int row)>& alpha) {
    const RasterSpec spec{
        .width = 256,
        .height = 256,
        .bands = 4,
        .transform = {{400000.0, 1.0, 0.0, 4200256.0, 0.0, -1.0}},
        .meanings = {GCI_RedBand, GCI_GreenBand, GCI_BlueBand, GCI_AlphaBand},
    };
    const std::string path = write_raster(folder / "a.tif", spec, [&](int band, int col, int row) {
      return band == 4 ? alpha(col, row) : 60.0 + (col + row) % 100;
    });
    return open_imagery({path}, {}, kZone, 2.0, detector)->summary().notes;
  };
  EXPECT_THAT(notes([](int col, int row) { return (3 * col + row) % 256; }),
              ::testing::ElementsAre(::testing::HasSubstr("vary as those of near infrared")));
  EXPECT_THAT(notes([](int col, int) { return col < 96 ? 2 * col : 255; }),
              ::testing::ElementsAre(::testing::HasSubstr("less than half opaque counts as not seen")));
  EXPECT_THAT(notes([](int col, int) { return std::clamp(32 * col - 512, 0, 255); }), ::testing::IsEmpty());
}

TEST(Imagery, OfMoreBandsThanColoursWithoutNamesGetsANote) {
  const testing::TemporaryFolder folder;
  const BlurDetector detector;
  const auto notes = [&](int bands, const std::vector<GDALColorInterp>& meanings) {
    const RasterSpec spec{.width = 256,
                          .height = 256,
                          .bands = bands,
                          .type = GDT_UInt16,
                          .transform = {{400000.0, 1.0, 0.0, 4200256.0, 0.0, -1.0}},
                          .meanings = meanings};
    const std::string path =
        write_raster(folder / "a.tif", spec, [](int, int col, int row) { return 600.0 + (col + row) % 300; });
    return open_imagery({path}, {}, kZone, 2.0, detector)->summary().notes;
  };
  constexpr GDALColorInterp kNone = GCI_Undefined;
  EXPECT_THAT(notes(4, {GCI_GrayIndex, kNone, kNone, kNone}),
              ::testing::ElementsAre(::testing::HasSubstr("which of its 4 bands are red, green and blue")));
  EXPECT_THAT(notes(3, {GCI_GrayIndex, kNone, kNone}), ::testing::IsEmpty());
  EXPECT_THAT(notes(4, {GCI_BlueBand, GCI_GreenBand, GCI_RedBand, kNone}), ::testing::IsEmpty());
  EXPECT_THAT(notes(3, {kNone, GCI_RedBand, GCI_GreenBand}),
              ::testing::ElementsAre(::testing::HasSubstr("not all of red, green and blue are named")))
      << "near infrared first";
}

TEST(Imagery, NotesAreThoseOfEachImageWhicheverComesFirst) {
  const testing::TemporaryFolder folder;
  const BlurDetector detector;
  const auto image = [&](const std::string& name, int bands, const std::vector<GDALColorInterp>& meanings) {
    const RasterSpec spec{.width = 256,
                          .height = 256,
                          .bands = bands,
                          .transform = {{400000.0, 1.0, 0.0, 4200256.0, 0.0, -1.0}},
                          .meanings = meanings};
    return write_raster(folder / name, spec,
                        [](int band, int col, int row) { return 20.0 + (band * 3 + 5 * col + row) % 200; });
  };
  constexpr GDALColorInterp kNone = GCI_Undefined;
  const std::string usual = image("a.tif", 3, {GCI_RedBand, GCI_GreenBand, GCI_BlueBand});
  const std::string unnamed = image("b.tif", 4, {GCI_GrayIndex, kNone, kNone, kNone});
  const std::string infrared = image("c.tif", 4, {GCI_RedBand, GCI_GreenBand, GCI_BlueBand, GCI_AlphaBand});
  const std::string again = image("d.tif", 5, {GCI_GrayIndex, kNone, kNone, kNone, kNone});
  const auto notes = [&](const std::vector<std::string>& paths) {
    return open_imagery(paths, {}, kZone, 2.0, detector)->summary().notes;
  };
  EXPECT_THAT(notes({usual}), ::testing::IsEmpty());
  EXPECT_THAT(notes({usual, unnamed, infrared}),
              ::testing::ElementsAre(::testing::StartsWith(unnamed), ::testing::StartsWith(infrared)));
  EXPECT_THAT(
      notes({usual, unnamed, again}),
      ::testing::ElementsAre(::testing::AllOf(
          ::testing::StartsWith(unnamed), ::testing::EndsWith("1 of its other images, the first of them " + again))));
}

TEST(Imagery, OfRealNumbersInOneBandIsSaidToLookLikeHeights) {
  const testing::TemporaryFolder folder;
  const BlurDetector detector;
  const auto notes = [&](GDALDataType type, double scale) {
    const RasterSpec spec{
        .width = 256, .height = 256, .type = type, .transform = {{400000.0, 1.0, 0.0, 4200256.0, 0.0, -1.0}}};
    const std::string path =
        write_raster(folder / "a.tif", spec, [=](int, int col, int row) { return scale * (700 + col + row); });
    return open_imagery({path}, {}, kZone, 2.0, detector)->summary().notes;
  };
  EXPECT_THAT(notes(GDT_Float32, 1.0), ::testing::ElementsAre(::testing::HasSubstr("as heights have")));
  EXPECT_THAT(notes(GDT_UInt16, 1.0), ::testing::IsEmpty());
  EXPECT_THAT(notes(GDT_Float32, 0.0005), ::testing::ElementsAre(::testing::HasSubstr("as those of probabilities")));
}

/// Nine control points of a raster of 1 m, the one in the middle so far off.
RasterSpec placed_by_points(double east_m, double north_m) {
  RasterSpec spec{.width = 400, .height = 400};
  for (const double row : {0.0, 200.0, 400.0}) {
    for (const double col : {0.0, 200.0, 400.0}) {
      const bool middle = row == 200.0 && col == 200.0;
      spec.control_points.push_back(
          {col, row, 400000.0 + col + (middle ? east_m : 0.0), 4200400.0 - row + (middle ? north_m : 0.0)});
    }
  }
  return spec;
}

SourceSummary summary_of_ramp(const std::string& path, const RasterSpec& spec) {
  const BlurDetector detector;
  write_raster(path, spec, [](int, int col, int) { return col % 200; });
  return open_imagery({path}, {}, kZone, 2.0, detector)->summary();
}

TEST(Imagery, IsAsUncertainAsItsControlPointsContradictEachOther) {
  const testing::TemporaryFolder folder;
  const SourceSummary exact = summary_of_ramp(folder / "exact.tif", placed_by_points(0.0, 0.0));
  EXPECT_EQ(exact.registration_sigma_m, 2.5);
  EXPECT_THAT(exact.notes, ::testing::IsEmpty());
  // In a fit of second order to 3 x 3 points that in the middle counts 5/9 for its own place, 2/9 for those beside it
  // and -1/9 for the corners, which count 29/36 for their own. Left out in turn they err by 1, 1/2 and 4/7 of what it
  // is off.
  constexpr double kSigma = 3.0 / 7.0;  // the root of (1 + 4 / 4 + 4 * 16 / 49) / (2 * 9)
  for (const auto& [east_m, north_m] : {std::pair(200.0, 0.0), {0.0, 200.0}, {-120.0, 160.0}}) {
    const SourceSummary off = summary_of_ramp(folder / "off.tif", placed_by_points(east_m, north_m));
    EXPECT_NEAR(off.registration_sigma_m, 200.0 * kSigma, 0.1);
    EXPECT_THAT(off.notes, ::testing::ElementsAre(::testing::HasSubstr("its 9 control points contradict each other")));
  }
}

TEST(Imagery, IsUncertainWhereAnErrorOfOneControlPointWouldNotShowInTheFitToAll) {
  const testing::TemporaryFolder folder;
  constexpr std::array<std::array<double, 2>, 7> kPlaces{
      {{20, 20}, {380, 20}, {20, 380}, {380, 380}, {200, 80}, {120, 240}, {280, 200}}};
  const auto summary = [&](std::size_t count, double east_m) {
    RasterSpec spec{.width = 400, .height = 400};
    for (std::size_t i = 0; i < count; ++i) {
      const auto [col, row] = kPlaces[i];
      spec.control_points.push_back({col, row, 400000.0 + col + (i == 1 ? east_m : 0.0), 4200400.0 - row});
    }
    return summary_of_ramp(folder / "a.tif", spec);
  };
  for (const double east_m : {0.0, 25.0}) {
    EXPECT_EQ(summary(3, east_m).registration_sigma_m, 10.0);
    EXPECT_THAT(summary(3, east_m).notes, ::testing::ElementsAre(::testing::HasSubstr("its 3 control points are so")));
  }
  for (const std::size_t count : {4U, 5U, 6U, 7U}) {
    EXPECT_EQ(summary(count, 0.0).registration_sigma_m, 2.5) << count;
    EXPECT_GT(summary(count, 25.0).registration_sigma_m, 25.0 / std::sqrt(2.0 * static_cast<double>(count))) << count;
    EXPECT_LT(summary(count, 25.0).registration_sigma_m, 60.0) << count;
    EXPECT_THAT(summary(count, 25.0).notes, ::testing::ElementsAre(::testing::HasSubstr("contradict each other")));
  }
}

TEST(Imagery, WithRationalPolynomialsBesideItsCoordinatesIsNotTakenForAnOrthoimage) {
  const testing::TemporaryFolder folder;
  const std::string path = folder / "a.tif";
  EXPECT_EQ(summary_of_ramp(path, {.width = 400, .height = 400}).registration_sigma_m, 2.5);
  {
    CPLStringList polynomials;
    for (const char* axis : {"LINE", "SAMP", "LAT", "LONG", "HEIGHT"}) {
      for (const char* part : {"OFF", "SCALE"}) polynomials.SetNameValue(fmt::format("{}_{}", axis, part).c_str(), "1");
    }
    for (const char* part : {"LINE_NUM", "LINE_DEN", "SAMP_NUM", "SAMP_DEN"}) {
      polynomials.SetNameValue(fmt::format("{}_COEFF", part).c_str(), "1 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0");
    }
    open_dataset(path, GDAL_OF_RASTER | GDAL_OF_UPDATE)->SetMetadata(polynomials.List(), "RPC");
  }
  const BlurDetector detector;
  const SourceSummary both = open_imagery({path}, {}, kZone, 2.0, detector)->summary();
  EXPECT_EQ(both.registration_sigma_m, 10.0);
  EXPECT_THAT(both.notes, ::testing::ElementsAre(::testing::HasSubstr("rational polynomials beside its coordinates")));
}

TEST(Imagery, IsAsUncertainBesidesAsTheWayFromItsDatum) {
  const testing::TemporaryFolder folder;
  const BlurDetector detector;
  const auto summary = [&](int epsg) {
    const RasterSpec spec{.epsg = epsg, .transform = {{300000.0, 1.0, 0.0, 6350000.0, 0.0, -1.0}}};
    const std::string path = write_raster(folder / "a.tif", spec, [](int, int col, int) { return 3 * col; });
    return open_imagery({path}, {}, *UtmZone::from_epsg(32719), 2.0, detector)->summary();
  };
  EXPECT_NEAR(summary(24879).registration_sigma_m, std::hypot(2.5, 20.0), 1e-9) << "PSAD56";
  EXPECT_NEAR(summary(29189).registration_sigma_m, std::hypot(2.5, 5.0), 1e-9) << "SAD69";
  EXPECT_THAT(summary(29189).notes, ::testing::ElementsAre(::testing::HasSubstr("is known to 5 m only")));
  EXPECT_EQ(summary(31979).registration_sigma_m, 2.5) << "SIRGAS 2000";
}

TEST(Imagery, ThatLooksLikeAMaskOrProbabilitiesGetsANote) {
  const testing::TemporaryFolder folder;
  const auto note = [&](GDALDataType type, const testing::PixelFunction& value) {
    const std::string path = write_raster(folder / "a.tif", {.type = type}, value);
    RasterFile file(path, {});
    return note_on_likely_roads(file);
  };
  const auto mask = [](int, int col, int) { return col < 31 ? 255.0 : 0.0; };
  const auto share = [](int, int col, int) { return col / 64.0; };
  const auto picture = [](int, int col, int row) { return (col + row) % 128; };
  EXPECT_THAT(note(GDT_Byte, mask), ::testing::Optional(::testing::HasSubstr("0 and 255, as those of a mask")));
  EXPECT_THAT(note(GDT_Float32, share), ::testing::Optional(::testing::HasSubstr("--as roads")));
  EXPECT_EQ(note(GDT_Byte, picture), std::nullopt);
  EXPECT_EQ(note(GDT_Float32, picture), std::nullopt);
  EXPECT_EQ(note(GDT_Byte, [](int, int, int) { return 7.0; }), std::nullopt);
}

TEST(Imagery, ThatLooksLikeAMaskWithAPaletteGetsANote) {
  const testing::TemporaryFolder folder;
  const auto note = [&](int colours) {
    const RasterSpec spec{.palette = {{0, 0, 0, 255}, {250, 250, 250, 255}, {90, 120, 60, 255}}};
    RasterFile file(write_raster(folder / "a.tif", spec, [=](int, int col, int) { return col / 8 % colours; }), {});
    return note_on_likely_roads(file);
  };
  EXPECT_THAT(note(2), ::testing::Optional(::testing::HasSubstr("0 and 1, as those of a mask")));
  EXPECT_EQ(note(3), std::nullopt);
}

}  // namespace
}  // namespace roadfix
