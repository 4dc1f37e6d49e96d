#include "core/locate/told_frames.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/ascii_map.hpp"
#include "tests/support/code_of.hpp"

namespace roadfix {
namespace {

using testing::from_ascii;

constexpr double kPlenty = 1e6;

FeatureMap frame_of(const char* rows) { return FeatureMap::centred(from_ascii(rows), 2.0); }

double sigma_of(const std::vector<PlacedFeatures>& parts) {
  return laid_together(parts, kPlenty).features.nadir_sigma_m;
}

TEST(LaidTogether, KnowsThePlaceNoBetterThanTheWayToTheFrameThatTellsIt) {
  const FeatureMap road = frame_of("#.. #.. #..");
  const FeatureMap field = frame_of("... ... ...");
  const BodyOffset behind{-300.0, 400.0, {}};
  EXPECT_NEAR(sigma_of({{field, {}}, {road, behind}}), 25.0, 1e-9);
  EXPECT_NEAR(sigma_of({{road, {}}, {field, behind}}), 0.0, 1e-9) << "it tells its place by itself";
  EXPECT_NEAR(sigma_of({{road, {}}, {frame_of("..# ..# ..#"), behind}}), 12.5, 1e-9);
  EXPECT_EQ(sigma_of({{field, {}}, {field, behind}}), 0.0) << "there is no place to know";
}

TEST(LaidTogether, AddsTheWayToWhatTheFramesKnowOfTheirNadirs) {
  FeatureMap leaning = frame_of("#.. #.. #..");
  leaning.nadir_sigma_m = 12.0;
  EXPECT_NEAR(sigma_of({{frame_of("... ..."), {}}, {leaning, {0.0, -100.0, {}}}}), 13.0, 1e-9);
}

TEST(LaidTogether, LeavesTheCellsToCombined) {
  const std::vector<PlacedFeatures> parts{{frame_of("#.. #.. #.."), {}}, {frame_of("### ... ..."), {4.0, 0.0, {}}}};
  EXPECT_EQ(laid_together(parts, kPlenty).features.cells, combined(parts, kPlenty).cells);
}

TEST(LaidTogether, LeavesOutWhatContradictsTheOthersAsIfItHadNotBeenGiven) {
  const auto frame_of_large_cells = [](const char* rows) { return FeatureMap::centred(from_ascii(rows), 20.0); };
  const FeatureMap road = frame_of_large_cells("#.... #.... ##### ..... .....");
  const FeatureMap same = frame_of_large_cells("#.... #.... ####9 ..... .....");
  const FeatureMap other = frame_of_large_cells("....# ....# ..... ...## ...#.");
  const std::vector<PlacedFeatures> parts{{road, {}}, {other, {0.0, 15.0, {}}}, {same, {}}};
  const std::vector<PlacedFeatures> rest{parts[0], parts[2]};
  const FramesTogether all = laid_together(parts, kPlenty);
  EXPECT_THAT(all.left_out, ::testing::ElementsAre(1));
  EXPECT_EQ(all.features, laid_together(rest, kPlenty).features);
}

TEST(LaidTogether, RefusesOnePictureFromTwoPlaces) {
  const FeatureMap road = frame_of("#.. #.. #..");
  const FeatureMap field = frame_of("... ... ...");
  const auto code_of_second_at = [&](const FeatureMap& both, const BodyOffset& offset) {
    const std::vector<PlacedFeatures> parts{{both, {}}, {both, offset}};
    return testing::code_of([&] { laid_together(parts, kPlenty); });
  };
  EXPECT_EQ(code_of_second_at(road, {-20.0, 0.0, {}}), "frames-repeated");
  EXPECT_EQ(code_of_second_at(road, {0.0, 0.0, Angle::degrees(9.0)}), "frames-repeated");
  EXPECT_EQ(code_of_second_at(road, {0.5, 0.0, {}}), "no error") << "a simulator that hovers";
  EXPECT_EQ(code_of_second_at(field, {-20.0, 0.0, {}}), "no error") << "one field is like the next";
}

TEST(LaidTogether, RefusesFramesFartherApartThanOnesOfAFlight) {
  const FeatureMap frame = FeatureMap::centred(CellArray(150, 150, kNoRoad), 2.0);
  const auto code_of_others_every = [&](double apart_m, int others) {
    std::vector<PlacedFeatures> parts{{frame, {}}};
    for (int i = 1; i <= others; ++i) parts.push_back({frame, {-apart_m * i, 0.0, {}}});
    return testing::code_of([&] { laid_together(parts, 16e6); });
  };
  EXPECT_EQ(code_of_others_every(12'000.0, 1), "frames-too-far-apart") << "a search would take a gigabyte";
  EXPECT_EQ(code_of_others_every(3000.0, 1), "frames-too-far-apart");
  EXPECT_EQ(code_of_others_every(1500.0, 1), "no error") << "five footprints";
  EXPECT_EQ(code_of_others_every(600.0, 7), "no error") << "every second footprint of a flight";
}

}  // namespace
}  // namespace roadfix
