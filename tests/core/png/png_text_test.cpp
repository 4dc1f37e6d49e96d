#include "core/png/png_text.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <string>

namespace roadfix {
namespace {

std::vector<std::uint8_t> picture() {
  std::vector<std::uint8_t> png;
  cv::imencode(".png", cv::Mat(7, 5, CV_8UC1, cv::Scalar(90)), png);
  return png;
}

TEST(PngText, ComesBackUnderItsKeyword) {
  const auto png = with_text(with_text(picture(), "Author", "somebody"), "Title", "a town");
  EXPECT_EQ(text_in(png, "Title"), "a town");
  EXPECT_EQ(text_in(png, "Author"), "somebody");
  EXPECT_EQ(text_in(png, "Auth"), std::nullopt);
  EXPECT_EQ(text_in(png, "Authors"), std::nullopt);
  EXPECT_EQ(text_in(picture(), "Author"), std::nullopt);
}

TEST(PngText, LeavesThePixelsAsTheyWere) {
  const cv::Mat pixels = cv::imdecode(with_text(picture(), "Title", "a town"), cv::IMREAD_UNCHANGED);
  EXPECT_EQ(cv::norm(pixels, cv::Mat(7, 5, CV_8UC1, cv::Scalar(90)), cv::NORM_INF), 0.0);
}

TEST(PngText, OfAnyLanguageIsAChunkOfItsOwnBesideTheOthers) {
  const auto png = with_text(with_utf8_text(picture(), "Copyright", "© a town"), "Title", "a town");
  const std::string chunk("iTXtCopyright\0\0\0\0\0© a town", 27);
  EXPECT_NE(std::string(png.begin(), png.end()).find(chunk), std::string::npos);
  EXPECT_EQ(text_in(png, "Title"), "a town");
  EXPECT_EQ(cv::norm(cv::imdecode(png, cv::IMREAD_UNCHANGED), cv::Mat(7, 5, CV_8UC1, cv::Scalar(90)), cv::NORM_INF),
            0.0);
}

TEST(PngText, IsNoneWhereItIsDamagedOrCutOff) {
  const auto png = with_text(picture(), "Title", "a town");
  const std::string text = "a town";
  auto damaged = png;
  *std::search(damaged.begin(), damaged.end(), text.begin(), text.end()) = 'A';
  EXPECT_EQ(text_in(damaged, "Title"), std::nullopt);
  const auto found = std::search(png.begin(), png.end(), text.begin(), text.end());
  const auto end = static_cast<std::size_t>(found - png.begin()) + text.size();
  for (std::size_t size = 0; size < end; ++size) {
    EXPECT_EQ(text_in(std::span(png).first(size), "Title"), std::nullopt) << size;
  }
}

TEST(PngText, IsLookedForBeforeThePixelsOnly) {
  const auto png = picture();
  const auto labelled = with_text(png, "Title", "a town");
  constexpr std::ptrdiff_t kHeaderEnd = 33;
  const auto chunk_size = static_cast<std::ptrdiff_t>(labelled.size() - png.size());
  auto behind = png;
  constexpr std::ptrdiff_t kEnd = 12;  // chunk IEND
  behind.insert(behind.end() - kEnd, labelled.begin() + kHeaderEnd, labelled.begin() + kHeaderEnd + chunk_size);
  EXPECT_EQ(text_in(behind, "Title"), std::nullopt);
}

}  // namespace
}  // namespace roadfix
