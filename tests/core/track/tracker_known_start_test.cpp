// Tracks that begin where the vehicle surely is.
#include <gtest/gtest.h>

#include <cstdint>

#include "core/track/tracker.hpp"
#include "tests/core/track/track_fixture.hpp"

namespace roadfix {
namespace {

using testing::Flight;
using testing::Track;
using testing::view_of;

class KnownStart : public Track {
 protected:
  /// `off_m`: how far to the east of the vehicle the middle of what is told lies.
  TrackSettings settings_at(const GridPose& start, double off_m = 20.0) const {
    TrackSettings told = settings();
    told.prior.circle = GeoCircle{view_.zone.unproject({start.position.east_m + off_m, start.position.north_m}), 30.0};
    told.prior.heading = HeadingRange{on_earth(start, view_.zone).heading + Angle::degrees(8.0), Angle::degrees(15.0)};
    told.start_is_known = true;
    return told;
  }

  /// With frames of 340 m: in those of 256 m two or three straight streets each way leave looks unsure.
  static Flight flight_over(const RoadGrid& ground, const GridPose& start, std::uint64_t seed) {
    Flight flight(ground, start, seed);
    flight.side_cells = 170;
    return flight;
  }

  RoadGrid blocks_ = testing::grid_city({2.0, {300'000, -3'200'000}, 800, 700}, 100.0);
  MapView blocks_view_ = view_of(blocks_);
};

TEST_F(KnownStart, ClaimsPlacesOverStreetsThatRepeat) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    Flight flight = flight_over(blocks_, start_, seed);
    state_ = {};
    int claimed = 0;
    fly(Tracker(blocks_view_, settings_at(start_)), flight, 25, [&](int i, const TrackEstimate& estimate) {
      if (!estimate.converged()) return;
      ++claimed;
      EXPECT_LT(error_m(estimate, flight.pose()), 15.0) << "seed " << seed << ", step " << i;
    });
    EXPECT_GE(claimed, 12) << "seed " << seed;
  }
}

TEST_F(KnownStart, OfNoOtherTrackIsClaimedThere) {
  TrackSettings guessed = settings_at(start_);
  guessed.start_is_known = false;
  Flight flight = flight_over(blocks_, start_, 1);
  fly(Tracker(blocks_view_, guessed), flight, 25,
      [&](int i, const TrackEstimate& estimate) { EXPECT_FALSE(estimate.converged()) << "step " << i; });
}

TEST_F(KnownStart, ThatIsWrongIsFoundOutWhereStreetsDiffer) {
  const Tracker tracker(view_, settings_at(start_, 200.0));
  Flight flight = flight_over(map_, start_, 4);
  int claimed = 0;
  fly(tracker, flight, 40, [&](int i, const TrackEstimate& estimate) {
    if (!estimate.converged()) return;
    ++claimed;
    EXPECT_LT(error_m(estimate, flight.pose()), 15.0) << "step " << i;
  });
  EXPECT_GT(claimed, 10);
}

TEST_F(KnownStart, IsNotBorneOutByASearchThatLooksNowhereElse) {
  Flight flight = flight_over(map_, start_, 4);
  const TrackEstimate first = advance(Tracker(view_, settings_at(start_)), flight.step());
  EXPECT_EQ(first.measurement, Measurement::kSearched);
  EXPECT_TRUE(first.since_accepted_s) << "it found one place within";
  EXPECT_FALSE(state_.claim.confirmed);
}

TEST_F(KnownStart, IsOfNoUseAnyMoreAfterAFlightThatWentTooFarUnseen) {
  const Tracker tracker(blocks_view_, settings_at(start_));
  Flight flight = flight_over(blocks_, start_, 1);
  fly(tracker, flight, 12);
  ASSERT_TRUE(state_.reach);
  for (int i = 0; i < 60 && state_.reach; ++i) advance(tracker, flight.step(false));
  EXPECT_FALSE(state_.reach);
  EXPECT_FALSE(state_.claim.confirmed);
  fly(tracker, flight, 15,
      [&](int i, const TrackEstimate& estimate) { EXPECT_FALSE(estimate.converged()) << "step " << i; });
}

TEST_F(KnownStart, BoundsNothingOfAVehicleThatFliesOffAndDoesNotTellHow) {
  for (const int hovering : {0, 12}) {
    const Tracker tracker(blocks_view_, settings_at(start_));
    Flight flight = flight_over(blocks_, start_, 1);
    flight.step_m = 0.0;
    state_ = {};
    EXPECT_EQ(fly(tracker, flight, hovering).converged(), hovering > 0);
    for (int i = 0; i < 25; ++i) {
      // A block further with each frame, and after eight of them back again: all look alike.
      const int blocks = i % 16 < 8 ? i % 8 + 1 : 8 - i % 8;
      flight.jump_to({{start_.position.east_m + 100.0 * blocks, start_.position.north_m}, start_.heading});
      StepInput step = flight.step();
      step.odometry.reset();
      step.time_us += std::int64_t{4'000'000} * (i + 1);  // 20 m/s
      const TrackEstimate estimate = advance(tracker, step);
      EXPECT_FALSE(estimate.converged()) << "hovered " << hovering << ", step " << i << ", "
                                         << error_m(estimate, flight.pose()) << " m off";
    }
  }
}

TEST_F(KnownStart, IsNoReasonToClaimAPlaceOutOfReachOfIt) {
  const Tracker tracker(blocks_view_, settings_at(start_));
  for (const double block : {-1.0, 1.0}) {
    Flight flight = flight_over(blocks_, start_, 2);
    state_ = {};
    ASSERT_TRUE(fly(tracker, flight, 12).converged());
    // The particles gather a block off, as those that are drawn anew may.
    for (double& east_m : state_.filter.particles.east_m) east_m += 100.0 * block;
    state_.claim.reopen();
    fly(tracker, flight, 15, [&](int i, const TrackEstimate& estimate) {
      EXPECT_FALSE(estimate.converged() && error_m(estimate, flight.pose()) > 25.0)
          << "step " << i << ", " << error_m(estimate, flight.pose()) << " m off";
    });
  }
}

TEST_F(KnownStart, WithoutAHeadingIsNoReasonToClaimOne) {
  // In the middle of a crossing all looks alike in four directions.
  const Tracker tracker(blocks_view_, settings_at(start_));
  Flight flight = flight_over(blocks_, start_, 2);
  flight.step_m = 0.0;
  ASSERT_TRUE(fly(tracker, flight, 12).converged());
  const GridPoint crossing{600'703.0, 6'399'397.0};
  const Angle quarter = Angle::degrees(90.0);
  Particles& p = state_.filter.particles;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const GridPoint off{p.east_m[i] - crossing.east_m, p.north_m[i] - crossing.north_m};
    const GridPose turned{{crossing.east_m + off.north_m, crossing.north_m - off.east_m},
                          (p.at(i).pose().heading + quarter).wrapped()};
    p.east_m[i] = turned.position.east_m;
    p.north_m[i] = turned.position.north_m;
    p.heading_rad[i] = turned.heading.radians();
  }
  state_.reach->heading_half_width = Angle::degrees(180.0);
  state_.claim.reopen();
  fly(tracker, flight, 12, [&](int i, const TrackEstimate& estimate) {
    EXPECT_FALSE(estimate.converged()) << "step " << i << ", turned by "
                                       << heading_error(estimate, flight.pose()).degrees();
  });
}

TEST_F(KnownStart, IsDroppedWhereFramesContradictWhatWasClaimed) {
  const Tracker tracker(blocks_view_, settings_at(start_));
  Flight flight = flight_over(blocks_, start_, 2);
  ASSERT_TRUE(fly(tracker, flight, 12).converged());
  flight.jump_to({{flight.pose().position.east_m + 50.0, flight.pose().position.north_m + 50.0},
                  flight.pose().heading + Angle::degrees(20.0)});
  fly(tracker, flight, 15,
      [&](int i, const TrackEstimate& estimate) { EXPECT_FALSE(estimate.converged()) << "step " << i; });
  EXPECT_FALSE(state_.reach);
}

}  // namespace
}  // namespace roadfix
