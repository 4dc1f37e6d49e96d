#include "cli/fly/film.hpp"

#include <gif_lib.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "tests/support/peak_memory.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roadfix::fly {
namespace {

/// Black and white pictures, most of whose pixels change from one to the next.
std::vector<cv::Mat> flickering(int seed) {
  std::vector<cv::Mat> pictures;
  cv::RNG random(static_cast<std::uint64_t>(seed));
  for (int i = 0; i < 4; ++i) {
    cv::Mat grey(12, 16, CV_8UC1);
    random.fill(grey, cv::RNG::UNIFORM, 0, 256);
    pictures.emplace_back();
    cv::merge(std::vector<cv::Mat>(3, grey > 127), pictures.back());
  }
  pictures.push_back(pictures.back());
  return pictures;
}

/// What a viewer shows of each picture of a GIF, which holds what changes.
std::vector<cv::Mat> shown(const std::string& file) {
  std::vector<cv::Mat> pictures;
  GifFileType* gif = DGifOpenFileName(file.c_str(), nullptr);
  if (gif == nullptr || DGifSlurp(gif) != GIF_OK) return pictures;
  cv::Mat screen(gif->SHeight, gif->SWidth, CV_8UC3);
  for (int i = 0; i < gif->ImageCount; ++i) {
    const SavedImage& image = gif->SavedImages[i];
    const GifImageDesc& part = image.ImageDesc;
    for (int pixel = 0; pixel < part.Width * part.Height; ++pixel) {
      const GifColorType& colour = gif->SColorMap->Colors[image.RasterBits[pixel]];
      screen.at<cv::Vec3b>(part.Top + pixel / part.Width, part.Left + pixel % part.Width) = {colour.Blue, colour.Green,
                                                                                             colour.Red};
    }
    pictures.push_back(screen.clone());
  }
  DGifCloseFile(gif, nullptr);
  return pictures;
}

TEST(Films, ShowEveryPictureOfTwoSideBySide) {
  const testing::TemporaryFolder folder;
  const std::vector<cv::Mat> ours = flickering(1);
  const std::vector<cv::Mat> theirs = flickering(2);
  Film film;
  Film other;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    film.add(ours[i]);
    other.add(theirs[i]);
  }
  film.append_right(other);
  std::ofstream(folder / "film.gif", std::ios::binary) << film.gif(8);
  const std::vector<cv::Mat> pictures = shown((folder / "film.gif").string());
  ASSERT_EQ(pictures.size(), ours.size());
  for (std::size_t i = 0; i < ours.size(); ++i) {
    cv::Mat both;
    cv::hconcat(ours[i], theirs[i], both);
    EXPECT_EQ(cv::norm(pictures[i], both, cv::NORM_INF), 0.0) << i;
  }
}

TEST(Films, KeepLittleOfWhatDoesNotChange) {
  if (ROADFIX_SANITIZED) GTEST_SKIP() << "sanitizers keep what was let go of";
  cv::Mat noise(900, 900, CV_8UC3);
  cv::RNG(3).fill(noise, cv::RNG::UNIFORM, 0, 256);
  Film film;
  film.add(noise);
  film.add(noise);
  const long before_kib = testing::peak_memory_kib();
  for (int i = 0; i < 60; ++i) film.add(noise);
  EXPECT_LT(testing::peak_memory_kib() - before_kib, 10 << 10) << "48 MB in full";
}

}  // namespace
}  // namespace roadfix::fly
