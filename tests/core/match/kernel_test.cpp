#include "core/match/kernel.hpp"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <random>

#include "core/grid/resample.hpp"
#include "core/match/kernel_vnni.hpp"
#include "tests/support/ascii_map.hpp"
#include "tests/support/padded_cells.hpp"
#include "tests/support/random_cells.hpp"

namespace roadfix {
namespace {

using testing::padded;
using testing::random_cells;

/// Cell by cell, the definition.
MatchSums scalar_sums(const CellArray& map, const FeatureMap& north_up, PlaneCell place) {
  MatchSums s;
  const int nadir_col = static_cast<int>(north_up.nadir.col);
  const int nadir_row = static_cast<int>(north_up.nadir.row);
  for (int r = 0; r < north_up.cells.rows(); ++r) {
    for (int c = 0; c < north_up.cells.cols(); ++c) {
      const Cell m = map.get(place.col + c - nadir_col, place.row + r - nadir_row);
      const Cell l = north_up.cells.at(c, r);
      if (!is_observed(m) || !is_observed(l)) continue;
      s.add(probability(m), probability(l));
    }
  }
  return s;
}

void expect_equal(const MatchSums& a, const MatchSums& b) {
  EXPECT_EQ(a.n, b.n);
  const double tolerance = 1e-9 * static_cast<double>(b.n + 1);
  EXPECT_NEAR(a.m, b.m, tolerance);
  EXPECT_NEAR(a.l, b.l, tolerance);
  EXPECT_NEAR(a.mm, b.mm, tolerance);
  EXPECT_NEAR(a.ll, b.ll, tolerance);
  EXPECT_NEAR(a.ml, b.ml, tolerance);
}

/// Each instruction set that this processor has, in turn; kBest is what runs outside of tests.
constexpr std::int64_t kBest = 0;
class KernelOnEachTarget : public ::testing::TestWithParam<std::int64_t> {
 protected:
  void SetUp() override {
    hwy::SetSupportedTargetsForTest(GetParam());
    allow_byte_products_for_test(GetParam() == kBest);
  }
  void TearDown() override {
    hwy::SetSupportedTargetsForTest(0);
    allow_byte_products_for_test(true);
  }
};

TEST_P(KernelOnEachTarget, AgreesWithTheDefinitionForRandomSizesPlacesAndHoles) {
  std::mt19937_64 random(7);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<std::uint64_t>(n)); };
  for (int round = 0; round < 150; ++round) {
    const double holes = round % 3 == 0 ? 0.0 : 0.1 * (round % 5);
    const CellArray cells = random_cells(random, 1 + below(150), 1 + below(90), holes);
    const FeatureMap features =
        FeatureMap::centred(random_cells(random, 1 + below(140), 1 + below(70), 0.1 * (round % 4)), 1.0);
    const PackedFootprint footprint(features);
    const int margin = 2 * footprint.reach() + round % 2;  // where the footprint leaves the map, it touches no cell
    const CellArray map = padded(cells, margin);
    const MapPlane plane(map);
    std::vector<PlaneCell> places;
    for (int i = 0; i < 13; ++i) places.push_back({below(400) - 150 + margin, below(300) - 100 + margin});
    std::vector<MatchSums> sums(places.size());
    match_sums(plane, footprint, places, sums);
    for (std::size_t i = 0; i < places.size(); ++i) expect_equal(sums[i], scalar_sums(map, features, places[i]));
    if (HasFailure()) FAIL() << "round " << round << " on " << kernel_target();
  }
}

TEST_P(KernelOnEachTarget, SumsAllAndProductsAloneWhereAllOfTheMapIsObserved) {
  std::mt19937_64 random(8);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<std::uint64_t>(n)); };
  for (int round = 0; round < 100; ++round) {
    const FeatureMap features =
        FeatureMap::centred(random_cells(random, 1 + below(140), 1 + below(70), 0.3 * (round % 4)), 1.0);
    const PackedFootprint footprint(features);
    const int reach = footprint.reach();
    const CellArray map = random_cells(random, 2 * reach + 1 + below(50), 2 * reach + 1 + below(50), 0.0);
    const MapPlane plane(map);
    std::vector<PlaneCell> places;
    for (int i = 0; i < 11; ++i) {
      places.push_back({reach + below(map.cols() - 2 * reach), reach + below(map.rows() - 2 * reach)});
    }
    std::vector<std::int64_t> products(places.size());
    product_sums(plane, footprint, places, products);
    std::vector<MatchSums> sums(places.size());
    match_sums(plane, footprint, places, sums);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const MatchSums expected = scalar_sums(map, features, places[i]);
      expect_equal(sums[i], expected);
      EXPECT_NEAR(static_cast<double>(products[i]), expected.ml * (kRoad * kRoad), 1e-3);
    }
    if (HasFailure()) FAIL() << "round " << round << " on " << kernel_target();
  }
}

TEST_P(KernelOnEachTarget, SumsOfAllRoadDoNotOverflow) {
  const int cols = 4000;
  const int rows = 700;
  const FeatureMap features = FeatureMap::centred(CellArray(cols, rows, kRoad), 1.0);
  const PackedFootprint footprint(features);
  const int margin = footprint.reach();
  const PlaneCell place{cols / 2 + margin, rows / 2 + margin};
  const CellArray all_observed(cols + 2 * margin, rows + 2 * margin, kRoad);
  const CellArray map(cols, rows, kRoad);
  CellArray with_hole = map;
  with_hole.at(5, 5) = kUnobserved;
  for (const CellArray& ground : {all_observed, padded(map, margin), padded(with_hole, margin)}) {
    const bool hole = !is_observed(ground.at(5 + margin, 5 + margin));
    const MapPlane plane(ground);
    MatchSums sums;
    match_sums(plane, footprint, std::span(&place, 1), std::span(&sums, 1));
    const double expected = static_cast<double>(cols) * rows - (hole ? 1 : 0);
    EXPECT_EQ(sums.n, static_cast<std::int64_t>(expected));
    EXPECT_NEAR(sums.m, expected, 1e-3);
    EXPECT_NEAR(sums.mm, expected, 1e-3);
    EXPECT_NEAR(sums.ml, expected, 1e-3);
  }
  std::int64_t products = 0;
  product_sums(MapPlane(padded(CellArray(cols, rows, kRoad), margin)), footprint, std::span(&place, 1),
               std::span(&products, 1));
  EXPECT_EQ(products, std::int64_t{cols} * rows * kRoad * kRoad);
}

INSTANTIATE_TEST_SUITE_P(Best, KernelOnEachTarget, ::testing::Values(kBest));
INSTANTIATE_TEST_SUITE_P(Targets, KernelOnEachTarget, ::testing::ValuesIn(hwy::SupportedAndGeneratedTargets()),
                         [](const auto& target) { return std::string(hwy::TargetName(target.param)); });

TEST(FootprintAt, TurnsAndShiftsTheFeatureMapLikeCuttingItOutOfTheGround) {
  // The window at a pose, laid back at that pose, fits the map perfectly; half a cell off it does not.
  std::mt19937_64 random(3);
  const RoadGrid grid{{1.0, {0, 0}, 80, 80}, testing::smooth_cells(random, 80, 80)};
  const Angle heading = Angle::degrees(37.0);
  const GridGeometry::CellPosition at{40.8, 39.7};
  const FeatureMap window = cut_out(grid, {grid.geometry.point_at(at), heading}, 31, 25, 1.0);
  const auto fit = [&](GridGeometry::CellPosition offset) {
    const PackedFootprint footprint = footprint_at(window, heading, offset);
    const int margin = footprint.reach();
    const MapPlane plane(padded(grid.cells, margin));
    const PlaneCell place{40 + margin, 39 + margin};
    MatchSums sums;
    match_sums(plane, footprint, std::span(&place, 1), std::span(&sums, 1));
    return rho(sums).value();
  };
  EXPECT_GT(fit({0.3, 0.2}), 0.97);
  EXPECT_GT(fit({0.3, 0.2}), fit({-0.2, 0.2}));
  EXPECT_GT(fit({0.3, 0.2}), fit({0.3, -0.3}));
}

}  // namespace
}  // namespace roadfix
