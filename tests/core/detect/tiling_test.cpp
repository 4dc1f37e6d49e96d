#include "core/detect/tiling.hpp"

#include <gtest/gtest.h>

namespace roadfix {
namespace {

TEST(Tiling, TilesCoverASideAndOverlapByAtLeastTheOverlap) {
  const TilePlan plan{64, 16, 2, 16};
  for (int length = 16; length <= 400; length += 16) {
    const auto starts = tile_starts(length, plan);
    EXPECT_EQ(starts.front(), 0);
    const int side = tile_side(length, plan);
    EXPECT_LE(side, plan.tile);
    EXPECT_EQ(side % plan.multiple, 0);
    EXPECT_EQ(starts.size() == 1U, length <= plan.tile);
    EXPECT_EQ(starts.back() + side, length);
    for (std::size_t i = 1; i < starts.size(); ++i) EXPECT_GE(starts[i - 1] + side - starts[i], plan.overlap);
  }
}

TEST(Tiling, ASideJustLongerThanATileTakesTwoOfHalfItsLength) {
  const TilePlan plan{.tile = 1024, .overlap = 64, .stride = 2, .multiple = 16};
  EXPECT_EQ(tile_side(1024, plan), 1024);
  EXPECT_EQ(tile_side(1040, plan), 560);
  EXPECT_EQ(tile_starts(1040, plan), (std::vector<int>{0, 480}));
}

TEST(Tiling, WeightsOfNeighboursSumToOneAcrossTheirOverlap) {
  const int cells = 32;
  const int overlap = 8;
  const auto weights = blend_weights(cells, overlap);
  for (int i = 0; i < overlap; ++i) {
    const float left = weights[static_cast<std::size_t>(cells - overlap + i)];
    const float right = weights[static_cast<std::size_t>(i)];
    EXPECT_NEAR(left + right, 1.0F, 2e-4F) << i;
  }
}

TEST(Tiling, TilesThatShowAConstantBlendToThatConstant) {
  const cv::Mat wanted(160, 224, CV_8UC1, cv::Scalar(255));
  const cv::Mat blended = blend_tiles(wanted, {64, 16, 2}, [](const cv::Rect& tile) {
    return cv::Mat(tile.height / 2, tile.width / 2, CV_32FC1, cv::Scalar(3.0));
  });
  ASSERT_EQ(blended.size(), cv::Size(112, 80));
  double min = 0.0;
  double max = 0.0;
  cv::minMaxLoc(blended, &min, &max);
  EXPECT_NEAR(min, 3.0, 1e-5);
  EXPECT_NEAR(max, 3.0, 1e-5);
}

TEST(Tiling, OnlyThePartOfATileAroundWantedPixelsIsRun) {
  cv::Mat wanted = cv::Mat::zeros(160, 160, CV_8UC1);
  wanted(cv::Rect(40, 20, 90, 70)).setTo(255);
  const TilePlan plan{.tile = 96, .overlap = 32, .stride = 2, .multiple = 16};
  const cv::Mat blended = blend_tiles(wanted, plan, [&](const cv::Rect& part) {
    EXPECT_EQ(part.x % 16 + part.y % 16 + part.width % 16 + part.height % 16, 0);
    EXPECT_EQ(part & cv::Rect(32, 16, 112, 80), part);
    cv::Mat columns(part.height / 2, part.width / 2, CV_32FC1);
    for (int col = 0; col < columns.cols; ++col) columns.col(col) = 0.5 * part.x + col;
    return columns;
  });
  for (int row = 10; row < 45; ++row) {
    for (int col = 20; col < 65; ++col)
      ASSERT_NEAR(static_cast<double>(blended.at<float>(row, col)), col, 1e-3) << row << ' ' << col;
  }
  EXPECT_EQ(blended.at<float>(5, 30), 0.0F);
}

TEST(Tiling, TilesWithoutAWantedPixelAreNotRun) {
  cv::Mat wanted = cv::Mat::zeros(64, 256, CV_8UC1);
  wanted.at<unsigned char>(5, 250) = 255;
  int runs = 0;
  blend_tiles(wanted, {64, 16, 2}, [&](const cv::Rect& tile) {
    ++runs;
    EXPECT_TRUE(tile.contains({250, 5}));
    return cv::Mat::ones(tile.height / 2, tile.width / 2, CV_32FC1);
  });
  EXPECT_EQ(runs, 1);
}

}  // namespace
}  // namespace roadfix
