#include "core/track/tracker.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "core/units/draws.hpp"
#include "tests/core/track/track_fixture.hpp"
#include "tests/support/code_of.hpp"

namespace roadfix {
namespace {

using testing::code_of;
using testing::Flight;
using testing::Track;
using testing::view_of;

TEST_F(Track, StartsBySearchAndFollowsTheFlight) {
  Flight flight(map_, start_, 1);
  flight.side_cells = 160;
  fly(Tracker(view_, settings()), flight, 25, [&](int i, const TrackEstimate& estimate) {
    if (i < 5) return;
    ASSERT_TRUE(estimate.converged()) << "step " << i;
    EXPECT_LT(error_m(estimate, flight.pose()), 10.0) << "step " << i;
    const Angle heading = view_.zone.true_from_grid(flight.pose().heading, flight.pose().position);
    EXPECT_LT(angular_distance(estimate.clusters[0].pose.heading, heading).degrees(), 4.0);
  });
  EXPECT_LT(state_.filter.particles.size(), 4000U);
}

/// Between two frames the belief grows by the errors of ten movements, to far more than the metres within which a frame
/// fits: one of 120 m has to say enough to narrow it down again.
TEST_F(Track, AcceptsMostSmallFramesThatComeEveryTenSteps) {
  const Tracker tracker(view_, settings());
  int frames = 0;
  int accepted = 0;
  for (const std::uint64_t seed : {1U, 2U}) {
    Flight flight(map_, start_, seed);
    flight.noise = {0.3, 0.3};
    flight.side_cells = 100;
    fly(tracker, flight, 3);
    flight.side_cells = 60;
    for (int i = 0; i < 150; ++i) {
      const bool sees = i % 10 == 9;
      const TrackEstimate estimate = advance(tracker, flight.step(sees));
      frames += sees ? 1 : 0;
      accepted += estimate.measurement == Measurement::kAccepted ? 1 : 0;
    }
    state_ = {};
  }
  EXPECT_GE(3 * accepted, 2 * frames);
}

/// That much of its weight is 300 m to the north of where it was, as if it had parted.
TrackerState parted(TrackerState state, double share) {
  std::vector<double>& north_m = state.filter.particles.north_m;
  const auto count = static_cast<std::ptrdiff_t>(share * static_cast<double>(north_m.size()));
  std::for_each(north_m.begin(), north_m.begin() + count, [](double& place_m) { place_m += 300.0; });
  return state;
}

TEST_F(Track, ClaimsNoPlaceThatItHasGoneOverToBeforeASearchAndALook) {
  const Tracker tracker(view_, settings());
  Flight flight(map_, start_, 1);
  ASSERT_TRUE(fly(tracker, flight, 12).converged());
  ASSERT_TRUE(state_.claim.is_told_apart() && state_.claim.looked_time_us);
  state_.last_search = state_.measured;
  const StepInput step = flight.step();
  EXPECT_TRUE(tracker.advance(state_, step).estimate.converged());
  const StepResult gone_over = tracker.advance(parted(state_, 0.7), step);
  EXPECT_LT(error_m(gone_over.estimate, flight.pose()), 15.0);
  EXPECT_FALSE(gone_over.estimate.converged());
  EXPECT_FALSE(gone_over.state.claim.confirmed || gone_over.state.claim.looked_time_us);
}

TEST_F(Track, ClaimsNoPlaceAgainBeforeALookWhereItPartedUnseen) {
  const Tracker tracker(view_, settings());
  Flight flight(map_, start_, 1);
  ASSERT_TRUE(fly(tracker, flight, 12).converged());
  StepInput unseen = flight.step();
  unseen.features.reset();
  EXPECT_TRUE(tracker.advance(state_, unseen).state.claim.looked_time_us);
  EXPECT_FALSE(tracker.advance(parted(state_, 0.5), unseen).state.claim.looked_time_us);
}

TEST_F(Track, CountsHowWellTheNadirIsKnownInItsAccuracy) {
  TrackSettings askew = settings();
  askew.vehicle.nadir_sigma_m = 12.0;
  Flight one(map_, start_, 1);
  const TrackEstimate exact = fly(Tracker(view_, settings()), one, 3);
  state_ = {};
  Flight same(map_, start_, 1);
  const TrackEstimate told = fly(Tracker(view_, askew), same, 3);
  EXPECT_EQ(told.clusters.at(0).pose.position.lat_deg, exact.clusters.at(0).pose.position.lat_deg);
  for (const std::size_t axis : {0U, 1U}) {
    EXPECT_NEAR(told.clusters[0].ellipse.sigma_m[axis], std::hypot(exact.clusters[0].ellipse.sigma_m[axis], 12.0),
                1e-9);
  }
}

TEST_F(Track, CountsHowWellTheNadirOfTheLastFrameIsKnownUnlessItIsToldForAll) {
  Flight flight(map_, start_, 1);
  const auto sigma_after = [&](const TrackSettings& settings, StepInput step) {
    state_ = Tracker(view_, settings).advance(state_, step).state;
    step.features.reset();
    ++step.sequence;
    ++step.time_us;
    return Tracker(view_, settings).advance(state_, step).estimate.clusters.at(0).ellipse.sigma_m[1];
  };
  StepInput step = flight.step();
  step.features->nadir_sigma_m = 300.0;
  EXPECT_NEAR(sigma_after(settings(), step), 300.0, 5.0);
  state_ = {};
  TrackSettings told = settings();
  told.vehicle.nadir_sigma_m = 100.0;
  EXPECT_NEAR(sigma_after(told, step), 100.0, 5.0);
}

TEST_F(Track, ConvergesFromAUniformBeliefWithoutSearch) {
  TrackSettings uniform = settings();
  uniform.start = TrackStart::kUniform;
  uniform.recovers = false;
  uniform.filter.max_particles = 20'000;
  uniform.prior.circle =
      GeoCircle{view_.zone.unproject({start_.position.east_m + 100.0, start_.position.north_m}), 250.0};
  Flight flight(map_, start_, 2);
  const TrackEstimate last = fly(Tracker(view_, uniform), flight, 25);
  EXPECT_TRUE(last.converged());
  EXPECT_LT(error_m(last, flight.pose()), 12.0);
}

TEST_F(Track, ThePapersFilterFindsTheUavToo) {
  TrackSettings paper = TrackSettings::paper(4'000);
  paper.prior.circle = GeoCircle{view_.zone.unproject(start_.position), 150.0};
  Flight flight(map_, start_, 3);
  flight.noise = {0.05, 0.05};
  std::vector<double> errors;
  fly(Tracker(view_, paper), flight, 40, [&](int i, const TrackEstimate& estimate) {
    if (i >= 30) errors.push_back(error_m(estimate, flight.pose()));
  });
  EXPECT_EQ(state_.filter.particles.size(), 4'000U);
  std::ranges::nth_element(errors, errors.begin() + 5);
  EXPECT_LT(errors[5], 40.0);
}

TEST_F(Track, GrowsLessSureWithoutSightAndSaysWhenItSawLast) {
  const Tracker tracker(view_, settings());
  Flight flight(map_, start_, 4);
  const TrackEstimate seeing = fly(tracker, flight, 10);
  TrackEstimate blind;
  for (int i = 0; i < 61; ++i) {
    blind = advance(tracker, flight.step(false));
    EXPECT_EQ(blind.measurement, Measurement::kNone);
  }
  EXPECT_TRUE(seeing.converged());
  EXPECT_FALSE(blind.converged()) << "a minute without sight is stale";
  EXPECT_DOUBLE_EQ(blind.since_accepted_s.value(), 61.0);
  EXPECT_GT(blind.clusters[0].ellipse.sigma_m[0], 2.0 * seeing.clusters[0].ellipse.sigma_m[0]);
}

TEST_F(Track, GrowsLessSureByAMeasurementThatSpeaksAgainstIt) {
  const Tracker tracker(view_, settings());
  Flight flight(map_, start_, 4);
  fly(tracker, flight, 10);
  StepInput next = flight.step(false);
  const double unseeing_m = tracker.advance(state_, next).estimate.clusters[0].ellipse.sigma_m[0];
  std::mt19937_64 random(2);
  next.features = testing::observed_at(map_, {{600'300.0, 6'399'100.0}, Angle()}, 128, 128, 2.0, {0.1, 0.1}, random);
  const TrackEstimate contradicted = tracker.advance(state_, next).estimate;
  EXPECT_EQ(contradicted.measurement, Measurement::kRejected);
  EXPECT_GT(contradicted.clusters[0].ellipse.sigma_m[0], std::hypot(unseeing_m, 3.0));
}

TEST_F(Track, CountsLostStepsAndWidensForThem) {
  const Tracker tracker(view_, settings());
  Flight flight(map_, start_, 7);
  fly(tracker, flight, 6);
  StepInput next = flight.step(false);
  const double sure = tracker.advance(state_, next).estimate.clusters[0].ellipse.sigma_m[0];
  next.sequence += 2;
  const TrackEstimate late = advance(tracker, next);
  EXPECT_EQ(late.missed_steps, 2);
  EXPECT_GT(late.clusters[0].ellipse.sigma_m[0], sure + 5.0);
}

TEST_F(Track, TellsTheDoubtOfItsFilterAndHowManyParticlesItHas) {
  const Tracker tracker(view_, settings());
  Flight flight(map_, start_, 7);
  fly(tracker, flight, 2);
  state_.filter.slow_fit = 0.8;
  state_.filter.fast_fit = 0.6;
  const TrackEstimate unseeing = advance(tracker, flight.step(false));
  EXPECT_NEAR(unseeing.doubt, 0.25, 1e-9);
  EXPECT_EQ(unseeing.particles, state_.filter.particles.size());
}

TEST_F(Track, TakesAFrameThatShowsNothingNeitherForNorAgainstItsPlace) {
  const Tracker tracker(view_, settings());
  StepInput input;
  input.time_us = 1'000'000;
  std::mt19937_64 random(7);
  input.features = testing::observed_at(map_, {{600'300.0, 6'399'100.0}, Angle()}, 128, 128, 2.0, {0.1, 0.1}, random);
  advance(tracker, input);
  const TrackClaim before = state_.claim;
  ++input.sequence;
  input.time_us += 1'000'000;
  input.odometry = Odometry{};
  input.features = FeatureMap::centred(CellArray(128, 128), 2.0);
  EXPECT_EQ(advance(tracker, input).measurement, Measurement::kUseless);
  EXPECT_EQ(state_.claim, before);
}

/// What a detector makes of ground without roads: probabilities of at most two steps above none.
CellArray bare_ground(int cols, int rows, std::mt19937_64& random) {
  CellArray cells(cols, rows);
  for (Cell& cell : cells.cells()) cell = static_cast<Cell>(kNoRoad + std::max(0.0, uniform(random, -4.0, 2.99)));
  return cells;
}

TEST_F(Track, TakesALakeNeitherForNorAgainstItsPlaceThoughADetectorSeesAFewPerMilleOfRoadThere) {
  Flight flight(map_, start_, 1);
  flight.side_cells = 160;
  ASSERT_TRUE(fly(Tracker(view_, settings()), flight, 6).converged());
  std::mt19937_64 random(7);
  const RoadGrid lake{map_.geometry, bare_ground(map_.geometry.cols, map_.geometry.rows, random)};
  const MapView over_the_lake = view_of(lake);
  StepInput input = flight.step();
  input.features = FeatureMap::centred(bare_ground(128, 128, random), 2.0);
  const TrackEstimate over_it = advance(Tracker(over_the_lake, settings()), input);
  EXPECT_EQ(over_it.measurement, Measurement::kUseless);
  EXPECT_TRUE(over_it.converged());
}

TEST_F(Track, IsFollowedBeyondTheRimOfItsMapAndBack) {
  // The map ends where the vehicle turns round: it flies up to 230 m beyond, where its frames show nothing of the map.
  const RoadGrid west = view_.read({2.0, {300'000, -3'200'000}, 400, 700});
  const MapView part = testing::view_of(west);
  const double rim_m = west.geometry.box().max.east_m;
  std::mt19937_64 random(12);
  GridPose pose{{rim_m - 160.0, 6'399'500.0}, Angle::degrees(90.0)};
  const auto flown = [&](const Tracker& tracker, int i) {
    StepInput input;
    input.sequence = i;
    input.time_us = 1'000'000 * (input.sequence + 1);
    if (i > 0) {
      const Angle turn = Angle::degrees(i >= 13 && i < 33 ? 9.0 : 0.0);
      pose = moved(pose, {20.0, 0.0, turn});
      input.odometry = Odometry{20.0 * uniform(random, 0.98, 1.02), 0.0, turn};
    }
    input.features = testing::observed_at(map_, pose, 160, 160, 2.0, {0.1, 0.1}, random);
    return advance(tracker, input);
  };
  const Tracker tracker(part, settings());
  double farthest_m = 0.0;
  for (int i = 0; i < 48; ++i) {
    const TrackEstimate estimate = flown(tracker, i);
    if (i < 5) continue;
    farthest_m = std::max(farthest_m, pose.position.east_m - rim_m);
    EXPECT_LT(error_m(estimate, pose), i < 42 ? 40.0 : 12.0) << "step " << i;
    EXPECT_EQ(estimate.resets, 0U);
  }
  EXPECT_GT(farthest_m, 200.0);
}

TEST_F(Track, BeginsAnewAfterALongGap) {
  const Tracker tracker(view_, settings());
  Flight flight(map_, start_, 8);
  fly(tracker, flight, 6);
  StepInput next = flight.step(false);
  next.time_us += 601'000'000;
  const TrackEstimate after = advance(tracker, next);
  EXPECT_EQ(after.resets, 1U);
  EXPECT_FALSE(after.converged());
  next = flight.step();
  next.time_us += 601'000'000;
  EXPECT_EQ(advance(tracker, next).measurement, Measurement::kSearched);
}

TEST_F(Track, ClaimsNoPlaceAtAStepWhoseFrameSpeaksAgainstIt) {
  const Tracker tracker(view_, settings());
  Flight flight(map_, start_, 21);
  ASSERT_TRUE(fly(tracker, flight, 8).converged());
  const GridPose here = flight.pose();
  flight.jump_to({{here.position.east_m - 400.0, here.position.north_m + 300.0}, here.heading});
  const TrackEstimate elsewhere = advance(tracker, flight.step());
  EXPECT_EQ(elsewhere.measurement, Measurement::kRejected);
  EXPECT_FALSE(elsewhere.converged());
}

TEST_F(Track, GivesTheSameAnswersWithAnyNumberOfThreadsAndFromItsState) {
  const Tracker tracker(view_, settings());
  Flight flight(map_, start_, 6);
  TrackerState state;
  for (int i = 0; i < 4; ++i) {
    const StepInput step = flight.step();
    StepLimits two;
    two.threads = 3;
    const StepResult serial = tracker.advance(state, step);
    EXPECT_TRUE(serial.state == tracker.advance(state, step, two).state) << "step " << i;
    EXPECT_TRUE(serial.state == Tracker(view_, settings()).advance(state, step).state) << "no state in the tracker";
    state = serial.state;
  }
}

TEST_F(Track, RefusesWhatItCannotUseAndNamesIt) {
  const Tracker tracker(view_, settings());
  Flight flight(map_, start_, 10);
  const TrackerState state = tracker.advance({}, flight.step()).state;
  StepInput step = flight.step();
  const auto refusal = [&](const std::function<void(StepInput&)>& change) {
    StepInput changed = step;
    change(changed);
    return code_of([&] { tracker.advance(state, changed); });
  };
  EXPECT_EQ(refusal([](StepInput& s) { s.sequence = 0; }), "step-late");
  EXPECT_EQ(refusal([](StepInput& s) { s.time_us = 1'000'000; }), "time-backwards");
  EXPECT_EQ(refusal([](StepInput& s) { s.time_us = 1'001'000; }), "impossible-speed") << "milliseconds";
  EXPECT_EQ(refusal([](StepInput& s) { s.time_us = 1'000'001; }), "impossible-speed") << "seconds";
  EXPECT_EQ(refusal([](StepInput& s) { s.odometry->forward_m = 1'100.0; }), "impossible-speed") << "in a second";
  EXPECT_EQ(refusal([](StepInput& s) { s.odometry->forward_m = 900.0; }), "no error");
  EXPECT_EQ(refusal([](StepInput& s) { s.odometry->forward_m = std::numeric_limits<double>::quiet_NaN(); }),
            "odometry-not-finite");
  EXPECT_EQ(refusal([](StepInput& s) {
              s.covariance = OdometryCovariance{{{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
            }),
            "covariance-not-positive");
  EXPECT_EQ(refusal([](StepInput& s) { s.features->cells = {}; }), "feature-map-empty");
  EXPECT_EQ(refusal([](StepInput& s) {
              s.time_us = 1'000'001;
              s.odometry->forward_m = 0.9;
            }),
            "no error")
      << "two frames at nearly the same time";
  EXPECT_EQ(refusal([](StepInput&) {}), "no error");
  step.covariance = OdometryCovariance{{{1, 2, 0}, {2, 1, 0}, {0, 0, 1}}};
  EXPECT_EQ(code_of([&] { tracker.advance({}, step); }), "covariance-not-positive")
      << "though a first step goes nowhere";
}

}  // namespace
}  // namespace roadfix
