#include "core/detect/road_detector.hpp"

#include <gtest/gtest.h>

namespace roadfix {
namespace {

constexpr const char* kNetwork = "neural roadnet-imagery-7 fnv1a64=cbf29ce484222325 gsd_m=1 orientations=1";
constexpr const char* kTree =
    "tree map=probabilistic gsd_m=0.5 trees_per_km2=3000 min_nodes=3 alpha=0.5 beta=0.8 gamma=0.5 epsilon=4 edge_px=12 "
    "fan=7 fan_half_width_deg=40 root_fan=16 max_nodes=200 max_explored_share=- max_area_px=- min_score=-";

TEST(SameReader, IsANetworkInHoweverManyOrientationsAndAtAnyScale) {
  EXPECT_TRUE(is_same_reader(kNetwork, kNetwork));
  EXPECT_TRUE(is_same_reader(kNetwork, "neural roadnet-imagery-7 fnv1a64=cbf29ce484222325 gsd_m=0.5 orientations=8"));
  EXPECT_TRUE(is_same_reader(kNetwork, "neural roadnet-imagery-7 fnv1a64=cbf29ce484222325"));
}

TEST(SameReader, IsNoneOfAnotherNameOrChecksum) {
  EXPECT_FALSE(is_same_reader(kNetwork, "neural roadnet-imagery-7 fnv1a64=0000000000000000 gsd_m=1 orientations=1"));
  EXPECT_FALSE(is_same_reader(kNetwork, "neural roadnet-7 fnv1a64=cbf29ce484222325 gsd_m=1 orientations=1"));
  EXPECT_FALSE(is_same_reader(kNetwork, kTree));
  EXPECT_FALSE(is_same_reader(kNetwork, ""));
}

TEST(SameReader, IsTheTreeWithOtherParametersButOfTheSameKindOfMap) {
  EXPECT_TRUE(is_same_reader(kTree, "tree map=probabilistic gsd_m=1 trees_per_km2=5000 min_nodes=3"));
  EXPECT_FALSE(is_same_reader(kTree, "tree map=binary gsd_m=0.5 trees_per_km2=3000 min_nodes=3"));
}

}  // namespace
}  // namespace roadfix
