#include "core/detect/feature_map_codec.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <string>

#include "core/png/png_text.hpp"
#include "core/units/error.hpp"
#include "tests/support/code_of.hpp"
#include "tests/support/encoded.hpp"

namespace roadfix {
namespace {

using testing::code_of;
using testing::encoded;

constexpr std::int64_t kEnough = 1'000'000;

TEST(FeatureMapCodec, HasNoMoreColumnsThanLibpngReads) {
  EXPECT_NO_THROW(encode_feature_map(CellArray(1'000'000, 1, kNoRoad)));
  EXPECT_EQ(code_of([] { encode_feature_map(CellArray(1'000'001, 1, kNoRoad)); }), "too-many-cells");
}

TEST(FeatureMapCodec, EveryCellValueComesBack) {
  CellArray cells(16, 16);
  for (int i = 0; i < 256; ++i) cells.at(i % 16, i / 16) = static_cast<Cell>(i);
  EXPECT_EQ(decode_feature_map(encode_feature_map(cells), kEnough).cells, cells);
}

TEST(FeatureMapCodec, WritesGreyAndAlphaAndNoColours) {
  constexpr std::size_t kColourType = 25;  // W3C PNG 11.2.2
  EXPECT_EQ(encode_feature_map(CellArray(3, 2, kRoad)).at(kColourType), 4);
}

TEST(FeatureMapCodec, AMaskOf255IsRoad) {
  const cv::Mat mask = (cv::Mat_<uchar>(1, 2) << 0, 255);
  const CellArray cells = decode_feature_map(encoded(".png", mask), kEnough).cells;
  EXPECT_EQ(cells.at(0, 0), kNoRoad);
  EXPECT_EQ(cells.at(1, 0), kRoad);
}

TEST(FeatureMapCodec, SixteenBitsScaleLinearly) {
  const cv::Mat deep = (cv::Mat_<ushort>(1, 3) << 0, 32768, 65535);
  const CellArray cells = decode_feature_map(encoded(".png", deep), kEnough).cells;
  EXPECT_NEAR(probability(cells.at(1, 0)), 0.5, 0.005);
  EXPECT_EQ(cells.at(2, 0), kRoad);
}

TEST(FeatureMapCodec, SixteenBitsThatHoldNoCertainRoadStayDoubtful) {
  cv::Mat deep(20, 20, CV_16UC1, cv::Scalar(655));
  deep.row(7).setTo(19661);
  const CellArray cells = decode_feature_map(encoded(".png", deep), kEnough).cells;
  EXPECT_NEAR(probability(cells.at(3, 7)), 0.3, 0.005);
  EXPECT_NEAR(probability(cells.at(3, 8)), 0.01, 0.005);
}

TEST(FeatureMapCodec, SixteenBitsWithAlphaBelowOneHalfAreUnobserved) {
  cv::Mat deep(1, 2, CV_16UC4, cv::Scalar(30000, 30000, 30000, 0x8000));
  deep.at<cv::Vec4w>(0, 1)[3] = 0x7FFF;
  const CellArray cells = decode_feature_map(encoded(".png", deep), kEnough).cells;
  EXPECT_TRUE(is_observed(cells.at(0, 0)));
  EXPECT_FALSE(is_observed(cells.at(1, 0)));
}

TEST(FeatureMapCodec, RefusesAFrameThatWasTakenForAFeatureMap) {
  cv::Mat frame(40, 40, CV_8UC3, cv::Scalar(90, 120, 100));
  EXPECT_EQ(code_of([&] { decode_feature_map(encoded(".png", frame), kEnough); }), "feature-map-coloured");
  EXPECT_EQ(code_of([&] { decode_feature_map(encoded(".jpg", frame), kEnough); }), "feature-map-coloured");
}

TEST(FeatureMapCodec, TakesGreyInAnyGuise) {
  cv::Mat mask(40, 40, CV_8UC1, cv::Scalar(0));
  cv::line(mask, {0, 7}, {39, 30}, cv::Scalar(255), 5);
  cv::Mat colour;
  cv::cvtColor(mask, colour, cv::COLOR_GRAY2BGR);
  for (const cv::Mat& picture : {mask, colour}) {
    for (const char* extension : {".png", ".jpg"}) {
      EXPECT_EQ(code_of([&] { decode_feature_map(encoded(extension, picture), kEnough); }), "no error") << extension;
    }
  }
  cv::Mat unseen;
  cv::cvtColor(colour, unseen, cv::COLOR_BGR2BGRA);
  unseen(cv::Rect(0, 0, 40, 20))
      .setTo(cv::Scalar(200, 10, 30, 0));  // editors leave any colour below what is transparent
  EXPECT_EQ(code_of([&] { decode_feature_map(encoded(".png", unseen), kEnough); }), "no error");
}

/// Of 12 x 9 cells, seen by a camera that leans: the point below the UAV lies behind its last row.
FeatureMap leaning() {
  CellArray cells(12, 9, kNoRoad);
  cells.at(3, 4) = kRoad;
  cells.at(0, 0) = kUnobserved;
  return {cells, 1.7, {6.25, 20.125}, 4.5, Angle::degrees(0.7)};
}

TEST(FeatureMapCodec, AFeatureMapComesBackWithItsCellSizeAndNadir) {
  const auto png = encode_feature_map(leaning());
  EXPECT_TRUE(is_feature_map(png));
  EXPECT_EQ(feature_map_of(decode_feature_map(png, kEnough), {}), leaning());
  EXPECT_EQ(feature_map_of(decode_feature_map(png, kEnough), {1.7, 6.25, 20.125}), leaning());
}

TEST(FeatureMapCodec, AFeatureMapSaysWhatFoundItsRoads) {
  const auto told = [](const std::vector<std::uint8_t>& png) { return decode_feature_map(png, kEnough).scale->reader; };
  EXPECT_EQ(told(encode_feature_map(leaning(), "neural roadnet-8 fnv1a64=1")), "neural roadnet-8 fnv1a64=1");
  EXPECT_EQ(told(encode_feature_map(leaning())), "");
  EXPECT_EQ(told(encode_feature_map(leaning(), std::string(10'000, '\x1f'))), std::string(500, '\x1f'));
}

TEST(FeatureMapCodec, APictureOfAnotherProgramIsCentredInTheCellsThatAreTold) {
  const auto png = encode_feature_map(leaning().cells);
  EXPECT_FALSE(is_feature_map(png));
  EXPECT_EQ(feature_map_of(decode_feature_map(png, kEnough), {3.0, {}, {}}), FeatureMap::centred(leaning().cells, 3.0));
  EXPECT_EQ(feature_map_of(decode_feature_map(png, kEnough), {3.0, {}, 40.0}).nadir.row, 40.0);
}

TEST(FeatureMapCodec, RefusesWhatContradictsThePicture) {
  const auto picture = decode_feature_map(encode_feature_map(leaning()), kEnough);
  EXPECT_EQ(code_of([&] { feature_map_of(picture, {2.0, {}, {}}); }), "cell-size-contradictory");
  EXPECT_EQ(code_of([&] { feature_map_of(picture, {1.7, 6.0, 4.5}); }), "nadir-contradictory");
  EXPECT_EQ(code_of([&] { feature_map_of(picture, {{}, 6.0, {}}); }), "nadir-contradictory");
}

TEST(FeatureMapCodec, RefusesAFeatureMapThatIsGivenAsAFrame) {
  EXPECT_EQ(code_of([&] { decode_frame(encode_feature_map(leaning()), kEnough); }), "frame-is-feature-map");
  EXPECT_EQ(code_of([&] { decode_frame(encode_feature_map(leaning().cells), kEnough); }), "no error");
}

/// The picture as a program leaves it that keeps the texts.
std::string refused_with(const std::string& text, const CellArray& cells) {
  const auto png = with_text(encode_feature_map(cells), "Roadfix feature map", text);
  return code_of([&] { decode_feature_map(png, kEnough); });
}

TEST(FeatureMapCodec, RefusesAFeatureMapThatWasCutOrScaledSinceItWasMade) {
  const std::string text = text_in(encode_feature_map(leaning()), "Roadfix feature map").value();
  EXPECT_EQ(refused_with(text, CellArray(12, 9, kNoRoad)), "no error");
  EXPECT_EQ(refused_with(text, CellArray(12, 8, kNoRoad)), "feature-map-altered");
  EXPECT_EQ(refused_with(text, CellArray(24, 18, kNoRoad)), "feature-map-altered");
}

TEST(FeatureMapCodec, RefusesAScaleThatCannotBe) {
  const auto told = [](const std::string& cell_m, const std::string& nadir, const std::string& heading_sigma = "0") {
    return R"({"cols":4,"rows":4,"nadir_sigma_m":0,"nadir_heading_sigma_rad":)" + heading_sigma + R"(,"cell_m":)" +
           cell_m + R"(,"nadir_cell":)" + nadir + "}";
  };
  const CellArray cells(4, 4, kNoRoad);
  EXPECT_EQ(refused_with(told("2", "[2,2]"), cells), "no error");
  for (const char* cell_m : {"0", "-1", "1e9", "1e999", "\"2\"", "null"}) {
    EXPECT_EQ(refused_with(told(cell_m, "[2,2]"), cells), "feature-map-altered") << cell_m;
  }
  for (const char* heading_sigma : {"-1", "4", "null"}) {
    EXPECT_EQ(refused_with(told("2", "[2,2]", heading_sigma), cells), "feature-map-altered") << heading_sigma;
  }
  for (const char* nadir : {"[2]", "2", "[1e9,0]", "[\"a\",0]"}) {
    EXPECT_EQ(refused_with(told("2", nadir), cells), "feature-map-altered") << nadir;
  }
  for (const std::string& text : {std::string(), std::string("nothing"), std::string("[]"), std::string(5000, '[')}) {
    EXPECT_EQ(refused_with(text, cells), "feature-map-altered") << text.substr(0, 20);
  }
}

}  // namespace
}  // namespace roadfix
