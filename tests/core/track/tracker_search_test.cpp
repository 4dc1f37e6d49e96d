// When a track searches, and which places it claims.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <optional>
#include <thread>

#include "core/track/track_search.hpp"
#include "core/track/tracker.hpp"
#include "core/units/draws.hpp"
#include "tests/core/track/track_fixture.hpp"

namespace roadfix {
namespace {

using testing::Flight;
using testing::Track;
using testing::view_of;

TEST_F(Track, ClaimsNoPlaceBeforeASearchHasToldItFromAllOthers) {
  TrackSettings uniform = settings();
  uniform.start = TrackStart::kUniform;
  uniform.filter.max_particles = 20'000;
  uniform.prior.circle = GeoCircle{view_.zone.unproject(start_.position), 250.0};
  TrackSettings unsearchable = uniform;
  unsearchable.max_search_km2 = 1e-3;
  for (const bool searches : {true, false}) {
    Flight flight(map_, start_, 2);
    state_ = {};
    const auto look = [&](int i, const TrackEstimate& estimate) {
      EXPECT_TRUE(!estimate.converged() || state_.last_search > 0) << "step " << i;
    };
    const TrackEstimate last = fly(Tracker(view_, searches ? uniform : unsearchable), flight, 25, look);
    EXPECT_LT(error_m(last, flight.pose()), 12.0);
    EXPECT_TRUE(state_.claim.outweighs_chance());
    EXPECT_EQ(last.converged(), searches);
  }
}

/// The town, and to the east of it the same streets once more, `share` as large.
RoadGrid with_a_smaller_twin(const RoadGrid& town, double share) {
  GridGeometry geometry = town.geometry;
  const int first = geometry.cols + 40;
  geometry.cols = first + static_cast<int>(share * geometry.cols);
  RoadGrid both{geometry, CellArray(geometry.cols, geometry.rows, kNoRoad)};
  for (int row = 0; row < geometry.rows; ++row) {
    for (int col = 0; col < town.geometry.cols; ++col) both.cells.at(col, row) = town.cells.get(col, row);
    for (int col = first; col < geometry.cols; ++col) {
      const Cell twin = town.cells.get(static_cast<int>((col - first) / share), static_cast<int>(row / share));
      if (is_observed(twin)) both.cells.at(col, row) = twin;
    }
  }
  return both;
}

TEST_F(Track, ClaimsNoPlaceWhoseStreetsLookThatWayFromAWrongAltitudeOnly) {
  constexpr double kShare = 0.9;
  const RoadGrid both = with_a_smaller_twin(map_, kShare);
  const MapView view = view_of(both);
  const Tracker tracker(view, settings());
  Flight flight(map_, start_, 6);
  flight.side_cells = 160;
  int searched = 0;
  for (int i = 0; i < 25; ++i) {
    StepInput step = flight.step();
    step.features->cell_m *= kShare;
    const TrackEstimate estimate = advance(tracker, step);
    searched += estimate.measurement == Measurement::kSearched ? 1 : 0;
    EXPECT_FALSE(estimate.converged()) << "step " << i << ", off by " << error_m(estimate, flight.pose());
  }
  EXPECT_GT(searched, 0);
}

TEST_F(Track, TakesAPlaceForARivalOfItselfWhereItFitsFarBetterAtAnotherSizeOfTheGround) {
  const TrackSettings exact = settings();
  const StepLimits unlimited;
  const TrackSearch searches(view_, exact, unlimited);
  Flight flight(map_, start_, 6);
  flight.side_cells = 160;
  const FeatureMap seen = *flight.step().features;
  const auto holds = [&](double told_size) {
    FeatureMap told = seen;
    told.cell_m *= told_size;
    const Fix fix = searches.find(told, {}, {}).value();
    EXPECT_LT(distance_m(view_.zone.project(fix.modes.at(0).pose.position), start_.position), 25.0) << told_size;
    return searches.holds_at_other_scales(fix, told, {});
  };
  EXPECT_TRUE(holds(1.0));
  EXPECT_TRUE(holds(1.03));
  EXPECT_FALSE(holds(1.08));
  EXPECT_FALSE(holds(1.0 / 1.08));
}

TEST_F(Track, TakesNoSearchForAFixThatItsCalibrationDoubts) {
  Flight flight(map_, start_, 1);
  flight.side_cells = 160;
  const StepInput first = flight.step();
  const auto accepted = [&](double highest) {
    TrackSettings s = settings();
    Calibration calibration = *shipped_calibration();
    calibration.highest = highest;
    s.calibration = std::make_shared<const Calibration>(calibration);
    const StepResult result = Tracker(view_, s).advance({}, first);
    EXPECT_EQ(result.estimate.measurement, Measurement::kSearched);
    return result.estimate.since_accepted_s.has_value();
  };
  EXPECT_TRUE(accepted(0.999));
  EXPECT_FALSE(accepted(0.5));
}

TEST_F(Track, ClaimsNoPlaceThatNoSearchIsNearlySureOf) {
  for (const double highest : {0.94, 0.96}) {
    TrackSettings s = settings();
    Calibration calibration = *shipped_calibration();
    calibration.highest = highest;
    s.calibration = std::make_shared<const Calibration>(calibration);
    Flight flight(map_, start_, 2);
    state_ = {};
    bool claimed = false;
    const TrackEstimate last = fly(Tracker(view_, s), flight, 15, [&](int, const TrackEstimate& estimate) {
      claimed = claimed || estimate.converged();
    });
    EXPECT_LT(error_m(last, flight.pose()), 12.0);
    EXPECT_TRUE(state_.claim.outweighs_chance());
    EXPECT_EQ(claimed, highest > 0.95) << highest;
  }
}

TEST_F(Track, ClaimsNoPlaceWhereOneBrightStrokeHidesFaintRoads) {
  // What is seen of the roads is faint, and a line that is none is not: chance agreements with it come often, and
  // particles gather at one of them.
  const auto stroke = [](FeatureMap& features, std::mt19937_64& random) {
    for (Cell& cell : features.cells.cells()) cell = static_cast<Cell>(cell / 10);
    const int row = static_cast<int>(uniform(random, 10, 110));
    const int col = static_cast<int>(uniform(random, 10, 80));
    const double slope = uniform(random, -1.0, 1.0);
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
    state_ = {};
    for (int i = 0; i < 25; ++i) {
      StepInput step = flight.step();
      stroke(*step.features, random);
      const TrackEstimate estimate = advance(tracker, step);
      EXPECT_TRUE(!estimate.converged() || error_m(estimate, flight.pose()) < 25.0)
          << "seed " << seed << ", step " << i;
    }
  }
}

TEST_F(Track, ClaimsNoPlaceAmongManyThatFitAlike) {
  // Particles gather at one of them by and by, the frames agree with it, and a search finds more than chance.
  const RoadGrid grid = testing::grid_city(map_.geometry, 120.0);
  const MapView view = testing::view_of(grid);
  Flight flight(grid, start_, 13);
  fly(Tracker(view, settings()), flight, 40,
      [](int i, const TrackEstimate& estimate) { EXPECT_FALSE(estimate.converged()) << "step " << i; });
}

TEST_F(Track, FindsAVehicleThatWasToldToBeWhereTheMapShowsNothing) {
  RoadGrid with_a_hole = map_;
  for (int row = 0; row < with_a_hole.cells.rows(); ++row) {
    for (int col = 500; col < with_a_hole.cells.cols(); ++col) with_a_hole.cells.at(col, row) = kUnobserved;
  }
  const MapView view = view_of(with_a_hole);
  TrackSettings wrong = settings();
  wrong.prior.circle = GeoCircle{view.zone.unproject({start_.position.east_m + 700.0, start_.position.north_m}), 100.0};
  const Tracker tracker(view, wrong);
  const GridPose truth{{600'500.0, 6'399'400.0}, Angle::degrees(60.0)};
  Flight flight(map_, truth, 5);
  flight.step_m = 2.0;
  const TrackEstimate last = fly(tracker, flight, 20);
  EXPECT_TRUE(last.converged());
  EXPECT_LT(error_m(last, flight.pose()), 12.0);
}

TEST_F(Track, GoesOnWhereTheTimeDoesNotSufficeForASearch) {
  const Tracker tracker(view_, settings());
  Flight flight(map_, start_, 5);
  fly(tracker, flight, 3);
  StepInput late = flight.step();
  late.time_us += 700'000'000;  // the belief is thrown away, and a search shall find it anew
  StepLimits limits;
  limits.deadline = Deadline({}, std::chrono::steady_clock::now());
  ASSERT_NO_THROW(state_ = tracker.advance(state_, late, limits).state);
  EXPECT_EQ(state_.last_search, state_.measured) << "it was tried";
  EXPECT_EQ(state_.last.value().sequence, late.sequence);
}

TEST_F(Track, StartsBySearchWithinTheTimeThatItHas) {
  Flight flight(map_, start_, 1);
  flight.side_cells = 160;
  StepLimits limits;
  limits.deadline = Deadline({}, std::chrono::steady_clock::now() + std::chrono::minutes(10));
  const StepResult result = Tracker(view_, settings()).advance({}, flight.step(), limits);
  EXPECT_EQ(result.estimate.measurement, Measurement::kSearched);
}

TEST_F(Track, NoticesAKidnappingAndRecovers) {
  const Tracker tracker(view_, settings());
  Flight flight(map_, start_, 5);
  fly(tracker, flight, 15);
  flight.jump_to({{601'200.0, 6'398'950.0}, Angle::degrees(200.0)});
  int recovered = -1;
  int searched = 0;
  for (int i = 0; i < 60 && recovered < 0; ++i) {
    const TrackEstimate estimate = advance(tracker, flight.step());
    searched += estimate.measurement == Measurement::kSearched ? 1 : 0;
    const bool right = error_m(estimate, flight.pose()) < 20.0;
    EXPECT_TRUE(i < 12 || right || !estimate.converged()) << "still sure of the wrong place";
    if (estimate.converged() && right) recovered = i;
  }
  EXPECT_EQ(searched, 1) << "what a search has found is followed";
  EXPECT_GE(recovered, 0);
  EXPECT_LT(recovered, 40);
}

TEST_F(Track, IsFoundAroundItsPlaceWhereASearchOverTheWholeMapOutlastsTheTime) {
  using std::chrono::steady_clock;
  MapView wide = view_;
  wide.extent.max.east_m += 10'000.0;
  const double far_east_m = wide.extent.max.east_m - 1000.0;
  std::optional<steady_clock::time_point> slow_until;
  int outlasted = 0;
  wide.read = [&](const GridGeometry& window) {
    if (slow_until && window.box().max.east_m > far_east_m) {
      ++outlasted;
      std::this_thread::sleep_until(*slow_until);
    }
    return view_.read(window);
  };
  TrackSettings near_start = settings();
  near_start.prior.circle = GeoCircle{view_.zone.unproject(start_.position), 300.0};
  const Tracker tracker(wide, near_start);
  Flight flight(map_, start_, 5);
  ASSERT_TRUE(fly(tracker, flight, 15).converged());

  // Time enough, on any machine, for what is searched around.
  const StepLimits unlimited;
  const TrackSearch searches(wide, near_start, unlimited);
  Prior around;
  around.circle = GeoCircle{view_.zone.unproject(start_.position), TrackSearch::kAroundM};
  const auto begin = steady_clock::now();
  ASSERT_TRUE(searches.find(*flight.step().features, around, {.search = {.scale_range = 0.15}}));
  const auto time = 10 * (steady_clock::now() - begin);

  flight.jump_to({{601'200.0, 6'398'950.0}, Angle::degrees(200.0)});
  bool recovered = false;
  for (int i = 0; i < 40 && !recovered; ++i) {
    StepLimits limits;
    limits.deadline = Deadline({}, steady_clock::now() + time);
    slow_until = steady_clock::now() + time / 3;
    StepResult result = tracker.advance(state_, flight.step(), limits);
    state_ = std::move(result.state);
    recovered = result.estimate.converged() && error_m(result.estimate, flight.pose()) < 20.0;
  }
  EXPECT_GT(outlasted, 0);
  EXPECT_TRUE(recovered);
}

TEST_F(Track, ClaimsNoPlaceAgainThatItLostSightOfBeforeASearchFindsItThere) {
  const Tracker tracker(view_, settings());
  std::mt19937_64 random(1);
  const FeatureMap stopped = testing::observed_at(map_, start_, 128, 128, 2.0, {}, random);
  const FeatureMap fog = FeatureMap::centred(CellArray(128, 128), 2.0);
  for (const std::optional<FeatureMap>& seen :
       {std::optional<FeatureMap>(), std::optional(stopped), std::optional(fog)}) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      Flight flight(map_, start_, seed);
      state_ = {};
      ASSERT_TRUE(fly(tracker, flight, 12).converged());
      bool lost = false;
      for (int i = 0; i < 45; ++i) {
        StepInput step = flight.step(false);
        step.features = seen;
        const TrackEstimate estimate = advance(tracker, step);
        EXPECT_FALSE(lost && estimate.converged()) << "seed " << seed << ", step " << i;
        lost = lost || !estimate.converged();
      }
      EXPECT_TRUE(lost);
    }
  }
}

TEST_F(Track, ClaimsNoOtherPlaceThatItsBeliefGoesOverToBeforeASearchFindsItThere) {
  const Tracker tracker(view_, settings());
  Flight flight(map_, start_, 1);
  ASSERT_TRUE(fly(tracker, flight, 12).converged());
  std::vector<double>& east_m = state_.filter.particles.east_m;
  for (std::size_t i = 0; i < east_m.size(); ++i) {
    if (i % 5 < 3) east_m[i] -= 300.0;
  }
  const TrackEstimate estimate = advance(tracker, flight.step());
  EXPECT_LT(error_m(estimate, flight.pose()), 15.0);
  EXPECT_EQ(estimate.measurement, Measurement::kAccepted);
  EXPECT_FALSE(estimate.converged());
}

TEST_F(Track, TakesItsClaimBackWhenThreeMeasurementsInARowSpeakAgainstIt) {
  // It drifts away faster than the odometry says.
  for (const double slip_m : {25.0, 40.0}) {
    const Tracker tracker(view_, settings());
    Flight flight(map_, start_, 5);
    state_ = {};
    ASSERT_TRUE(fly(tracker, flight, 12).converged());
    int rejected = 0;
    int max_rejected = 0;
    for (int i = 0; i < 12; ++i) {
      StepInput step = flight.step();
      GridPose off = flight.pose();
      off.position.east_m += slip_m * (i + 1);
      std::mt19937_64 random(static_cast<std::uint64_t>(i));
      step.features = testing::observed_at(map_, off, 128, 128, 2.0, {0.3, 0.3}, random);
      const TrackEstimate estimate = advance(tracker, step);
      rejected = estimate.measurement == Measurement::kRejected ? rejected + 1 : 0;
      max_rejected = std::max(max_rejected, rejected);
      EXPECT_FALSE(rejected >= 3 && state_.claim.is_supported()) << slip_m << " m a step, step " << i;
    }
    EXPECT_GE(max_rejected, 3) << slip_m << " m a step";
  }
}

TEST_F(Track, IsFoundByItsLastFramesTogetherWhereEachShowsTooLittle) {
  TrackSettings few = settings();
  few.filter.max_particles = 800;  // too few to find the place without a search
  int found = 0;
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    Flight flight(map_, start_, seed);
    flight.side_cells = 28;
    state_ = {};
    const auto look = [&](int i, const TrackEstimate& estimate) {
      EXPECT_TRUE(!estimate.converged() || error_m(estimate, flight.pose()) < 25.0)
          << "seed " << seed << ", step " << i;
    };
    const TrackEstimate last = fly(Tracker(view_, few), flight, 40, look);
    found += error_m(last, flight.pose()) < 25.0 ? 1 : 0;
  }
  EXPECT_GE(found, 3) << "one, when each search has a single frame";
}

TEST_F(Track, KeepsItsLastFramesWhileItIsNotPlacedAndKnowsHowItMoved) {
  const RoadGrid elsewhere = testing::street_map(52, map_.geometry);
  const auto kept = [&](const RoadGrid& ground, const TrackSettings& s, const std::function<void(StepInput&)>& change) {
    const Tracker tracker(view_, s);
    Flight flight(ground, start_, 6);
    state_ = {};
    fly(tracker, flight, 8);
    StepInput last = flight.step();
    change(last);
    advance(tracker, last);
    return state_.recent.frames().size();
  };
  const auto as_it_is = [](StepInput&) {};
  EXPECT_EQ(kept(elsewhere, settings(), as_it_is), 3U);
  EXPECT_EQ(kept(map_, settings(), as_it_is), 0U) << "it is placed";
  EXPECT_EQ(kept(elsewhere, settings(), [](StepInput& s) { s.odometry.reset(); }), 1U);
  EXPECT_EQ(kept(elsewhere, settings(), [](StepInput& s) { s.sequence += 1; }), 1U) << "a step was lost";
  EXPECT_EQ(kept(elsewhere, settings(), [](StepInput& s) { s.time_us += 601'000'000; }), 1U);
  TrackSettings blown = settings();
  blown.vehicle.wind = {5.0};
  EXPECT_EQ(kept(elsewhere, blown, as_it_is), 1U) << "the wind may have carried it anywhere";
  EXPECT_EQ(kept(elsewhere, TrackSettings::paper(500), as_it_is), 0U) << "it never searches";
}

}  // namespace
}  // namespace roadfix
