#include "core/track/track_claim.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace roadfix {
namespace {

const double kHundredToOne = std::log(100.0);

TrackClaim supported_by(int measurements) {
  TrackClaim claim;
  for (int i = 0; i < measurements; ++i) claim.accept();
  return claim;
}

TEST(TrackClaim, IsSupportedByThreeMeasurements) {
  EXPECT_FALSE(supported_by(2).is_supported());
  EXPECT_TRUE(supported_by(3).is_supported());
  TrackClaim found = supported_by(2);
  found.confirm(0.98);
  EXPECT_TRUE(found.is_supported()) << "a search that found it counts as one";
}

TEST(TrackClaim, IsSupportedByThreeMeasurementsHoweverManySpokeAgainstItBefore) {
  TrackClaim claim;
  for (int i = 0; i < 10; ++i) claim.reject();
  claim.accept();
  claim.accept();
  EXPECT_FALSE(claim.is_supported());
  claim.accept();
  EXPECT_TRUE(claim.is_supported());
}

TEST(TrackClaim, IsTakenBackByThreeRejectionsInARowHoweverLongItWasSupported) {
  TrackClaim claim = supported_by(1000);
  claim.reject();
  claim.reject();
  EXPECT_TRUE(claim.is_supported());
  claim.reject();
  EXPECT_FALSE(claim.is_supported());
}

TEST(TrackClaim, WaitsForAnotherSearchWhereItWasTakenBack) {
  TrackClaim claim = supported_by(3);
  claim.confirmed = true;
  claim.reject();
  claim.accept();
  EXPECT_TRUE(claim.is_supported());
  EXPECT_FALSE(claim.confirmed);
}

TEST(TrackClaim, WaitsForAnotherSearchAndALookWhereOtherPlacesWereTakenIn) {
  TrackClaim claim = supported_by(3);
  claim.confirmed = true;
  claim.bear_out(1);
  claim.reopen();
  EXPECT_TRUE(claim.is_supported());
  EXPECT_FALSE(claim.confirmed);
  EXPECT_FALSE(claim.looked_time_us);
}

TEST(TrackClaim, WaitsForALookWhereSomethingSpokeAgainstItOrASearchHasJustFoundIt) {
  TrackClaim rejected;
  rejected.bear_out(7'000'000);
  rejected.reject();
  EXPECT_FALSE(rejected.looked_time_us);
  TrackClaim found;
  found.bear_out(7'000'000);
  found.confirm(0.98);
  EXPECT_FALSE(found.looked_time_us);
}

TEST(TrackClaim, OutweighsChanceFromAHundredToOne) {
  TrackClaim claim;
  claim.weigh(kHundredToOne - 0.01);
  EXPECT_FALSE(claim.outweighs_chance());
  claim.weigh(0.02);
  EXPECT_TRUE(claim.outweighs_chance());
}

TEST(TrackClaim, WaitsForASearchOnceItOutweighsChanceUntilOneTellsItApart) {
  TrackClaim claim;
  claim.set_confirmed(true);
  EXPECT_FALSE(claim.is_told_apart() || claim.waits_for_search()) << "it is no more than chance";
  claim.weigh(kHundredToOne);
  EXPECT_TRUE(claim.is_told_apart());
  claim.set_confirmed(false);
  EXPECT_FALSE(claim.is_told_apart());
  EXPECT_TRUE(claim.waits_for_search());
}

TEST(TrackClaim, ForgetsWhatSpokeAgainstItBeforeMeasurementsSpeakForIt) {
  TrackClaim claim;
  claim.confirmed = true;
  claim.weigh(-1000.0);
  EXPECT_FALSE(claim.confirmed);
  claim.weigh(kHundredToOne);
  EXPECT_TRUE(claim.outweighs_chance());
}

TEST(TrackClaim, IsLostSoonAlsoWhereItWasRightForLong) {
  TrackClaim claim;
  for (int i = 0; i < 1000; ++i) claim.weigh(10.0);
  claim.weigh(-kHundredToOne + 0.01);
  EXPECT_TRUE(claim.outweighs_chance()) << "not by one measurement of less than a hundred to one";
  claim.weigh(-0.02);
  EXPECT_FALSE(claim.outweighs_chance());
}

TEST(TrackClaim, IsAsSureOfAFixAsTheFixIs) {
  TrackClaim claim;
  claim.confirm(0.98);
  EXPECT_TRUE(claim.confirmed);
  EXPECT_NEAR(claim.log_odds, std::log(49.0), 1e-9);
  EXPECT_FALSE(claim.is_supported());
}

TEST(TrackClaim, CountsTheWayFromTheLastSearchThatBoreItOut) {
  TrackClaim claim;
  claim.fly(30.0);
  claim.fly(40.0);
  EXPECT_EQ(claim.flown_m, 40.0) << "no search has borne it out: since the step before";
  claim.bear_out(7'000'000);
  EXPECT_EQ(claim.looked_time_us, 7'000'000);
  claim.fly(30.0);
  claim.fly(40.0);
  EXPECT_EQ(claim.flown_m, 70.0);
}

}  // namespace
}  // namespace roadfix
