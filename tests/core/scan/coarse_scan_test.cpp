#include "core/scan/coarse_scan.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "core/grid/resample.hpp"
#include "core/match/footprint.hpp"
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

}  // namespace
}  // namespace roadfix
