#include "core/locate/tracker.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "core/grid/resample.hpp"
#include "core/locate/particle_matches.hpp"
#include "core/units/error.hpp"
#include "tests/support/code_of.hpp"
#include "tests/support/flight.hpp"
#include "tests/support/map_view.hpp"

namespace roadfix {
namespace {

using testing::code_of;
using testing::Flight;

class Track : public ::testing::Test {
 protected:
  RoadGrid map_ = testing::street_map(51, {2.0, {300'000, -3'200'000}, 800, 700});
  MapView view_ = testing::view_of(map_);
  GridPose start_{{600'700.0, 6'399'400.0}, Angle::degrees(60.0)};

  static TrackSettings settings() {
    TrackSettings s;
    s.filter.max_particles = 4000;
    s.filter.min_particles = 500;
    return s;
  }
  double error_m(const TrackEstimate& estimate, const GridPose& truth) const {
    return distance_m(view_.zone.project(estimate.clusters.at(0).pose.position), truth.position);
  }
};

TEST_F(Track, StartsBySearchAndFollowsTheFlight) {
  const Tracker tracker(view_, settings());
  Flight flight(map_, start_, 1);
  TrackerState state;
  for (int i = 0; i < 25; ++i) {
    const StepResult result = tracker.advance(state, flight.step());
    state = result.state;
    if (i < 5) continue;
    ASSERT_TRUE(result.estimate.converged) << "step " << i;
    EXPECT_LT(error_m(result.estimate, flight.pose()), 10.0) << "step " << i;
    const Angle heading = view_.zone.true_from_grid(flight.pose().heading, flight.pose().position);
    EXPECT_LT(angular_distance(result.estimate.clusters[0].pose.heading, heading).degrees(), 4.0);
  }
  EXPECT_LT(state.filter.particles.size(), 4000U);
}

TEST_F(Track, ConvergesFromAUniformBeliefWithoutSearch) {
  TrackSettings uniform = settings();
  uniform.start = TrackStart::kUniform;
  uniform.recovers = false;
  uniform.filter.max_particles = 20'000;
  uniform.prior.circle =
      GeoCircle{view_.zone.unproject({start_.position.east_m + 100.0, start_.position.north_m}), 250.0};
  const Tracker tracker(view_, uniform);
  Flight flight(map_, start_, 2);
  TrackerState state;
  TrackEstimate last;
  for (int i = 0; i < 25; ++i) {
    StepResult result = tracker.advance(state, flight.step());
    state = std::move(result.state);
    last = std::move(result.estimate);
  }
  EXPECT_TRUE(last.converged);
  EXPECT_LT(error_m(last, flight.pose()), 12.0);
}

TEST_F(Track, ClaimsNoPlaceBeforeASearchHasToldItFromAllOthers) {
  TrackSettings uniform = settings();
  uniform.start = TrackStart::kUniform;
  uniform.filter.max_particles = 20'000;
  uniform.prior.circle = GeoCircle{view_.zone.unproject(start_.position), 250.0};
  TrackSettings unsearchable = uniform;
  unsearchable.max_search_km2 = 1e-3;
  for (const bool searches : {true, false}) {
    const Tracker tracker(view_, searches ? uniform : unsearchable);
    Flight flight(map_, start_, 2);
    TrackerState state;
    TrackEstimate last;
    for (int i = 0; i < 25; ++i) {
      StepResult result = tracker.advance(state, flight.step());
      state = std::move(result.state);
      last = std::move(result.estimate);
      EXPECT_TRUE(!last.converged || state.last_search > 0) << "step " << i;
    }
    EXPECT_LT(error_m(last, flight.pose()), 12.0);
    EXPECT_GE(state.evidence, std::log(100.0));
    EXPECT_EQ(last.converged, searches);
  }
}

TEST_F(Track, ThePapersFilterFindsTheUavToo) {
  TrackSettings paper = TrackSettings::paper(4'000);
  paper.prior.circle = GeoCircle{view_.zone.unproject(start_.position), 150.0};
  const Tracker tracker(view_, paper);
  Flight flight(map_, start_, 3);
  flight.noise = {0.05, 0.05};
  TrackerState state;
  std::vector<double> errors;
  for (int i = 0; i < 40; ++i) {
    const StepResult result = tracker.advance(state, flight.step());
    state = result.state;
    if (i >= 30) errors.push_back(error_m(result.estimate, flight.pose()));
  }
  EXPECT_EQ(state.filter.particles.size(), 4'000U);
  std::ranges::nth_element(errors, errors.begin() + 5);
  EXPECT_LT(errors[5], 40.0);
}

TEST_F(Track, GrowsLessSureWithoutSightAndSaysWhenItSawLast) {
  const Tracker tracker(view_, settings());
  Flight flight(map_, start_, 4);
  TrackerState state;
  TrackEstimate seeing;
  for (int i = 0; i < 10; ++i) {
    StepResult result = tracker.advance(state, flight.step());
    state = std::move(result.state);
    seeing = std::move(result.estimate);
  }
  TrackEstimate blind;
  for (int i = 0; i < 61; ++i) {
    StepResult result = tracker.advance(state, flight.step(false));
    state = std::move(result.state);
    blind = std::move(result.estimate);
    EXPECT_EQ(blind.measurement, Measurement::kNone);
  }
  EXPECT_TRUE(seeing.converged);
  EXPECT_FALSE(blind.converged) << "a minute without sight is stale";
  EXPECT_DOUBLE_EQ(blind.since_accepted_s.value(), 61.0);
  EXPECT_GT(blind.clusters[0].sigma_m[0], 2.0 * seeing.clusters[0].sigma_m[0]);
}

TEST_F(Track, TakesNoSearchForAFixThatItsCalibrationDoubts) {
  Flight flight(map_, start_, 1);
  const StepInput first = flight.step();
  const auto accepted = [&](double highest) {
    TrackSettings s = settings();
    Calibration calibration = default_calibration();
    calibration.highest = highest;
    s.calibration = std::make_shared<const Calibration>(calibration);
    const StepResult result = Tracker(view_, s).advance({}, first);
    EXPECT_EQ(result.estimate.measurement, Measurement::kSearched);
    return result.estimate.since_accepted_s.has_value();
  };
  EXPECT_TRUE(accepted(0.999));
  EXPECT_FALSE(accepted(0.5));
}

TEST_F(Track, ClaimsNoPlaceWhereOneBrightStrokeHidesFaintRoads) {
  // What is seen of the roads is faint, and a line that is none is not: chance agreements with it come often, and
  // particles gather at one of them.
  const auto stroke = [](FeatureMap& features, std::mt19937_64& random) {
    for (Cell& cell : features.cells.cells()) cell = static_cast<Cell>(cell / 10);
    const int row = static_cast<int>(testing::uniform(random, 10, 110));
    const int col = static_cast<int>(testing::uniform(random, 10, 80));
    const double slope = testing::uniform(random, -1.0, 1.0);
    for (int i = 0; i < 40; ++i) {
      for (int k = 0; k < 5; ++k) {
        features.cells.at(col + i, std::clamp(row + static_cast<int>(slope * i) + k, 0, 127)) = kRoad;
      }
    }
  };
  const Tracker tracker(view_, settings());
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    Flight flight(map_, start_, seed);
    std::mt19937_64 random(seed);
    TrackerState state;
    for (int i = 0; i < 25; ++i) {
      StepInput step = flight.step();
      stroke(*step.features, random);
      StepResult result = tracker.advance(state, step);
      state = std::move(result.state);
      EXPECT_TRUE(!result.estimate.converged || error_m(result.estimate, flight.pose()) < 25.0)
          << "seed " << seed << ", step " << i;
    }
  }
}

TEST_F(Track, ClaimsNoPlaceAmongManyThatFitAlike) {
  // Particles gather at one of them by and by, the frames agree with it, and a search finds more than chance.
  const RoadGrid grid = testing::grid_city(map_.geometry, 120.0);
  const MapView view = testing::view_of(grid);
  const Tracker tracker(view, settings());
  Flight flight(grid, start_, 13);
  TrackerState state;
  for (int i = 0; i < 40; ++i) {
    StepResult result = tracker.advance(state, flight.step());
    state = std::move(result.state);
    EXPECT_FALSE(result.estimate.converged) << "step " << i;
  }
}

TEST_F(Track, GoesOnWhereTheTimeDoesNotSufficeForASearch) {
  const Tracker tracker(view_, settings());
  Flight flight(map_, start_, 5);
  TrackerState state;
  for (int i = 0; i < 3; ++i) state = tracker.advance(state, flight.step()).state;
  StepInput late = flight.step();
  late.time_us += 700'000'000;  // the belief is thrown away, and a search shall find it anew
  StepLimits limits;
  limits.search_time = std::chrono::milliseconds(1);
  ASSERT_NO_THROW(state = tracker.advance(state, late, limits).state);
  EXPECT_EQ(state.last_search, state.measured) << "it was tried";
  EXPECT_EQ(state.sequence, late.sequence);
}

TEST_F(Track, NoticesAKidnappingAndRecovers) {
  const Tracker tracker(view_, settings());
  Flight flight(map_, start_, 5);
  TrackerState state;
  for (int i = 0; i < 15; ++i) state = tracker.advance(state, flight.step()).state;
  flight.jump_to({{601'200.0, 6'398'950.0}, Angle::degrees(200.0)});
  int recovered = -1;
  for (int i = 0; i < 60 && recovered < 0; ++i) {
    const StepResult result = tracker.advance(state, flight.step());
    state = result.state;
    const bool right = error_m(result.estimate, flight.pose()) < 20.0;
    EXPECT_TRUE(i < 12 || right || !result.estimate.converged) << "still sure of the wrong place";
    if (result.estimate.converged && right) recovered = i;
  }
  EXPECT_GE(recovered, 0);
  EXPECT_LT(recovered, 40);
}

TEST_F(Track, IsFoundByItsLastFramesTogetherWhereEachShowsTooLittle) {
  TrackSettings few = settings();
  few.filter.max_particles = 800;  // too few to find the place without a search
  const Tracker tracker(view_, few);
  int found = 0;
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    Flight flight(map_, start_, seed);
    flight.side_cells = 28;
    TrackerState state;
    TrackEstimate last;
    for (int i = 0; i < 40; ++i) {
      StepResult result = tracker.advance(state, flight.step());
      state = std::move(result.state);
      last = std::move(result.estimate);
      EXPECT_TRUE(!last.converged || error_m(last, flight.pose()) < 25.0) << "seed " << seed << ", step " << i;
    }
    found += error_m(last, flight.pose()) < 25.0 ? 1 : 0;
  }
  EXPECT_GE(found, 3) << "one, when each search has a single frame";
}

TEST_F(Track, KeepsItsLastFramesWhileItIsNotPlacedAndKnowsHowItMoved) {
  const RoadGrid elsewhere = testing::street_map(52, map_.geometry);
  const auto kept = [&](const RoadGrid& ground, const TrackSettings& s, const std::function<void(StepInput&)>& change) {
    const Tracker tracker(view_, s);
    Flight flight(ground, start_, 6);
    TrackerState state;
    for (int i = 0; i < 9; ++i) {
      StepInput step = flight.step();
      if (i == 8) change(step);
      state = tracker.advance(state, step).state;
    }
    return state.recent.frames().size();
  };
  const auto as_it_is = [](StepInput&) {};
  EXPECT_EQ(kept(elsewhere, settings(), as_it_is), 3U);
  EXPECT_EQ(kept(map_, settings(), as_it_is), 0U) << "it is placed";
  EXPECT_EQ(kept(elsewhere, settings(), [](StepInput& s) { s.odometry.reset(); }), 1U);
  EXPECT_EQ(kept(elsewhere, settings(), [](StepInput& s) { s.sequence += 1; }), 1U) << "a step was lost";
  EXPECT_EQ(kept(elsewhere, settings(), [](StepInput& s) { s.time_us += 601'000'000; }), 1U);
  TrackSettings blown = settings();
  blown.vehicle.wind_walk = 0.1;
  EXPECT_EQ(kept(elsewhere, blown, as_it_is), 1U) << "the wind may have carried it anywhere";
  EXPECT_EQ(kept(elsewhere, TrackSettings::paper(500), as_it_is), 0U) << "it never searches";
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

/// The town of Track, of which the map knows only what lies west of a line, and a vehicle that flies east.
class TrackBeyondTheMap : public Track {
 protected:
  TrackBeyondTheMap() {
    part_.read = [whole = view_.read](const GridGeometry& geometry) {
      RoadGrid grid = whole(geometry);
      for (int row = 0; row < grid.geometry.rows; ++row) {
        for (int col = 0; col < grid.geometry.cols; ++col) {
          if (grid.geometry.cell_center(col, row).east_m > 600'950.0) grid.cells.at(col, row) = kUnobserved;
        }
      }
      return grid;
    };
  }

  TrackEstimate fly(const Tracker& tracker, const GridPose& pose, double seconds) {
    StepInput step;
    step.sequence = state_.sequence + 1;
    step.time_us = state_.time_us + static_cast<std::int64_t>(1e6 * seconds);
    if (step.sequence > 0) step.odometry = Odometry{20.0, 0.0, Angle()};
    step.features = testing::observed_at(map_, pose, 128, 128, 2.0, {0.1, 0.1}, random_);
    StepResult result = tracker.advance(state_, step);
    state_ = std::move(result.state);
    return std::move(result.estimate);
  }
  /// 28 steps; the last ones see nothing that the map shows.
  TrackEstimate fly_out(const Tracker& tracker) {
    TrackEstimate last;
    for (int i = 0; i < 28; ++i) {
      last = fly(tracker, {{600'650.0 + 20.0 * i, 6'399'400.0}, Angle::degrees(90.0)}, 1.0);
      if (i == 8) {
        EXPECT_LT(error_m(last, {{600'650.0 + 20.0 * i, 6'399'400.0}, Angle::degrees(90.0)}), 25.0);
      }
    }
    return last;
  }

  MapView part_ = view_;
  std::mt19937_64 random_{12};
  TrackerState state_;
};

TEST_F(TrackBeyondTheMap, TakesNothingFromFramesOfGroundThatTheMapDoesNotShow) {
  const TrackEstimate last = fly_out(Tracker(part_, settings()));
  EXPECT_EQ(last.measurement, Measurement::kUseless);
  EXPECT_LT(last.doubt, 0.4) << "nothing speaks against the belief";
  EXPECT_LT(error_m(last, {{600'650.0 + 20.0 * 27, 6'399'400.0}, Angle::degrees(90.0)}), 40.0);
}

TEST_F(TrackBeyondTheMap, SearchesAnewWhereNothingWasAcceptedForAMinute) {
  const Tracker tracker(part_, settings());
  fly_out(tracker);
  // In truth it is elsewhere, over ground that the map shows; where it believes to be, no frame can tell.
  GridPose pose{{600'420.0, 6'398'900.0}, Angle::degrees(90.0)};
  TrackEstimate last;
  for (int i = 0; i < 14; ++i, pose.position.east_m += 20.0) last = fly(tracker, pose, 10.0);
  EXPECT_LT(error_m(last, {{pose.position.east_m - 20.0, pose.position.north_m}, pose.heading}), 20.0);
}

TEST_F(Track, CountsLostStepsAndWidensForThem) {
  const Tracker tracker(view_, settings());
  Flight flight(map_, start_, 7);
  TrackerState state;
  for (int i = 0; i < 6; ++i) state = tracker.advance(state, flight.step()).state;
  StepInput next = flight.step(false);
  const double sure = tracker.advance(state, next).estimate.clusters[0].sigma_m[0];
  next.sequence += 2;
  const StepResult late = tracker.advance(state, next);
  EXPECT_EQ(late.estimate.missed_steps, 2);
  EXPECT_GT(late.estimate.clusters[0].sigma_m[0], sure + 5.0);
}

TEST_F(Track, BeginsAnewAfterALongGap) {
  const Tracker tracker(view_, settings());
  Flight flight(map_, start_, 8);
  TrackerState state;
  for (int i = 0; i < 6; ++i) state = tracker.advance(state, flight.step()).state;
  StepInput next = flight.step(false);
  next.time_us += 601'000'000;
  const StepResult after = tracker.advance(state, next);
  EXPECT_EQ(after.estimate.resets, 1U);
  EXPECT_FALSE(after.estimate.converged);
  next = flight.step();
  next.time_us += 601'000'000;
  EXPECT_EQ(tracker.advance(after.state, next).estimate.measurement, Measurement::kSearched);
}

TEST_F(Track, GoesOnByEquation4OrConstantVelocityWithoutOdometry) {
  TrackSettings planar = settings();
  planar.vehicle.planar = VehicleNoise::Planar{{20.0, 1.0}, {0.0, 0.05}};
  const Tracker tracker(view_, planar);
  Flight flight(map_, start_, 9);
  TrackerState state = tracker.advance({}, flight.step()).state;
  TrackEstimate last;
  for (int i = 0; i < 15; ++i) {
    StepInput step = flight.step();
    step.odometry.reset();
    StepResult result = tracker.advance(state, step);
    state = std::move(result.state);
    last = std::move(result.estimate);
  }
  EXPECT_LT(error_m(last, flight.pose()), 15.0);
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
  EXPECT_EQ(refusal([](StepInput& s) { s.odometry->forward_m = std::numeric_limits<double>::quiet_NaN(); }),
            "odometry-not-finite");
  EXPECT_EQ(refusal([](StepInput& s) {
              s.covariance = OdometryCovariance{{{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
            }),
            "covariance-not-positive");
  EXPECT_EQ(refusal([](StepInput& s) { s.features->cells = {}; }), "feature-map-empty");
  EXPECT_EQ(refusal([](StepInput&) {}), "no error");
}

TEST_F(Track, WeighsParticlesAsEquation5DoesAtTheirPoses) {
  std::mt19937_64 random(11);
  const FeatureMap features = testing::observed_at(map_, start_, 100, 90, 2.0, {0.1, 0.1}, random);
  Particles p;
  p.resize(300);
  for (std::size_t i = 0; i < p.size(); ++i) {
    p.set(i, {start_.position.east_m + testing::uniform(random, -20, 20),
              start_.position.north_m + testing::uniform(random, -20, 20),
              start_.heading.radians() + testing::uniform(random, -0.1, 0.1)});
    p.weight[i] = i == 7 ? 0.0 : 1.0;
  }
  const auto sums = match_particles(view_, features, p);
  EXPECT_EQ(sums[7].n, 0);
  double difference = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (i == 7) continue;
    // Brute force: the map cut out at the very pose.
    const FeatureMap below = cut_out(map_, p.at(i).pose(), 100, 90, 2.0);
    MatchSums exact;
    for (int r = 0; r < 90; ++r) {
      for (int c = 0; c < 100; ++c) {
        if (!is_observed(below.cells.at(c, r))) continue;
        const double m = probability(below.cells.at(c, r));
        const double l = probability(features.cells.at(c, r));
        ++exact.n;
        exact.m += m;
        exact.l += l;
        exact.mm += m * m;
        exact.ll += l * l;
        exact.ml += m * l;
      }
    }
    difference += std::abs(*rho(sums[i]) - *rho(exact)) / 299.0;
  }
  EXPECT_LT(difference, 0.05) << "nearest cell and shared heading bins";
}

}  // namespace
}  // namespace roadfix
