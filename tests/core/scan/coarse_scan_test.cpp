#include "core/scan/coarse_scan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "core/grid/resample.hpp"
#include "core/match/footprint.hpp"
#include "core/match/kernel.hpp"
#include "core/match/score.hpp"
#include "tests/support/street_map.hpp"

namespace roadfix {
namespace {

/// Of a narrow window, at these bins of 100, over the middle of a map.
std::vector<ScanPose> maxima_at(std::vector<int> headings) {
  const RoadGrid map = testing::street_map(5, {8.0, {40'000, -500'000}, 160, 160});
  const GridPose middle{map.geometry.box().centre(), Angle::degrees(50.0)};
  const FeatureMap window = cut_out(map, middle, 40, 6, 8.0);
  const int reach = footprint_reach(window);
  ScanRequest request;
  request.positions = map.geometry.padded(-reach);
  request.bins = HeadingBins(100);
  request.headings = std::move(headings);
  request.eligible = [](int, int) { return true; };
  return coarse_scan(ScanMap(map, reach, scan_block(window)), window, request, Deadline()).maxima;
}

// Those of a range across north: its ends share no means, though they follow each other in the scan.
TEST(CoarseScan, ScoresAHeadingAlikeWhateverIsScannedBesideItsNeighbours) {
  std::vector<ScanPose> beside_another = maxima_at({10, 85});
  std::erase_if(beside_another, [](const ScanPose& pose) { return pose.bin == 10; });
  const std::vector<ScanPose> alone = maxima_at({85});
  ASSERT_FALSE(alone.empty());
  ASSERT_EQ(beside_another.size(), alone.size());
  for (std::size_t i = 0; i < alone.size(); ++i) {
    EXPECT_NEAR(beside_another[i].score, alone[i].score, 1e-4) << i;
  }
}

/// A window of a map of several tiles, part of which was not observed, at all headings of 24.
class CoarseScans : public ::testing::Test {
 protected:
  CoarseScans() {
    paste(CellArray(14, 9), map_.cells, 200, 50);
    const GridPose truth{map_.geometry.cell_center(310, 61), Angle::degrees(203.0)};
    window_ = cut_out(map_, truth, 36, 27, 8.0);
    window_.nadir = {15.3, 16.6};
    reach_ = footprint_reach(window_);
    request_.positions = map_.geometry.padded(-reach_);
    request_.bins = HeadingBins(24);
    for (int bin = 0; bin < 24; ++bin) request_.headings.push_back(bin);
    request_.eligible = [](int col, int row) { return (col + 3 * row) % 11 != 0; };
  }

  ScanResult scanned() const {
    return coarse_scan(ScanMap(map_, reach_, scan_block(window_)), window_, request_, Deadline());
  }

  /// By their definition, row by row; 0 where a position is not eligible.
  std::vector<double> exact(int bin) const {
    const GridGeometry& positions = request_.positions;
    std::vector<PlaneCell> places;
    for (int row = 0; row < positions.rows; ++row) {
      for (int col = 0; col < positions.cols; ++col) places.push_back({col + reach_, row + reach_});
    }
    std::vector<MatchSums> sums(places.size());
    match_sums(MapPlane(map_.cells), footprint_at(FeatureRotator(window_), request_.bins.heading(bin)), places, sums);
    std::vector<double> scores;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const bool counts = request_.eligible(places[i].col - reach_, places[i].row - reach_);
      scores.push_back(counts ? score_of(sums[i], footprint_cells(window_)) : 0.0);
    }
    return scores;
  }

  RoadGrid map_ = testing::street_map(7, {8.0, {40'000, -500'000}, 420, 110});
  FeatureMap window_;
  int reach_ = 0;
  ScanRequest request_;
};

TEST_F(CoarseScans, ScoreEachPoseByItsDefinitionToSomePercent) {
  const ScanResult result = scanned();
  std::map<int, std::vector<double>> exact_of;
  double squares = 0.0;
  double poses = 0.0;
  double best = 0.0;
  for (const int bin : request_.headings) {
    exact_of[bin] = exact(bin);
    for (const double score : exact_of[bin]) {
      squares += score * score;
      poses += score == 0.0 ? 0.0 : 1.0;
      best = std::max(best, score);
    }
  }
  EXPECT_NEAR(static_cast<double>(result.poses), poses, 0.01 * poses);
  EXPECT_NEAR(result.score_square_sum, squares, 0.02 * squares);
  ASSERT_FALSE(result.maxima.empty());
  EXPECT_NEAR(static_cast<double>(result.maxima.front().score), best, 0.03);
  // On bare ground beside roads some are much too high.
  double off = 0.0;
  double far_off = 0.0;
  for (const ScanPose& pose : result.maxima) {
    const auto at = static_cast<std::size_t>(pose.row * request_.positions.cols + pose.col);
    const double error = std::abs(static_cast<double>(pose.score) - exact_of[pose.bin][at]);
    off += error;
    far_off += error > 0.05 ? 1.0 : 0.0;
  }
  const auto count = static_cast<double>(result.maxima.size());
  EXPECT_LT(off, 0.01 * count);
  EXPECT_LT(far_off, 0.02 * count);
}

TEST_F(CoarseScans, KeepTheBestMaxima) {
  request_.keep = 1000;
  const std::vector<ScanPose> all = scanned().maxima;
  request_.keep = 20;
  const std::vector<ScanPose> best = scanned().maxima;
  ASSERT_EQ(best.size(), 20U);
  ASSERT_GT(all.size(), 20U);
  EXPECT_TRUE(std::ranges::is_sorted(all, std::ranges::greater{}, &ScanPose::score));
  for (std::size_t i = 0; i < best.size(); ++i) EXPECT_EQ(best[i].score, all[i].score) << i;
}

TEST_F(CoarseScans, TellHowManyHeadingsAreDone) {
  std::vector<std::size_t> told;
  request_.headings = {3, 4, 9, 15, 16};  // 3 and 4 turned by half a turn are 15 and 16
  request_.scanned = [&](std::size_t headings) { told.push_back(headings); };
  EXPECT_EQ(scanned().share, 1.0);
  EXPECT_EQ(told, (std::vector<std::size_t>{4, 5}));
}

}  // namespace
}  // namespace roadfix
