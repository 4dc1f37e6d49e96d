#include "cli/fly/flight.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <memory>

#include "cli/fly/area.hpp"
#include "tests/support/code_of.hpp"
#include "tests/support/map_view.hpp"
#include "tests/support/sloping_ground.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roadfix::fly {
namespace {

using testing::code_of;

const GridBox kBox{{600'500.0, 6'399'000.0}, {601'500.0, 6'400'000.0}};

/// Shows everything, sees one cell.
class Window : public Sensor {
 public:
  Observation observe(const Outlook&, evaluation::Random& random) const override {
    return {FeatureMap::centred(CellArray(1, 1, static_cast<Cell>(random() % 200)), 2.0), {}};
  }
  bool shows(GridPoint) const override { return true; }
};

/// Remembers where and how it was looked.
class Witness : public Window {
 public:
  Observation observe(const Outlook& from, evaluation::Random& random) const override {
    places.push_back(from.pose.position);
    scales.push_back(from.scale);
    return Window::observe(from, random);
  }
  mutable std::vector<GridPoint> places;
  mutable std::vector<double> scales;
};

class Flights : public ::testing::Test {
 protected:
  Flight flown(std::uint64_t seed = 1) const {
    const auto pilot = make_random_pilot(kBox, plan.handling);
    return fly(plan, kBox, *pilot, sensor, seed, [] {});
  }
  static int frames(const Flight& flight) {
    return static_cast<int>(
        std::ranges::count_if(flight, [](const FlightStep& m) { return m.input.features.has_value(); }));
  }

  FlightPlan plan;
  Window sensor;
};

TEST_F(Flights, AreTheSameForTheSameSeedAndOthersForAnother) {
  const Flight flight = flown(7);
  const Flight again = flown(7);
  ASSERT_EQ(flight.size(), 100u);
  for (std::size_t i = 0; i < flight.size(); ++i) {
    EXPECT_EQ(flight[i].truth.position, again[i].truth.position);
    EXPECT_EQ(flight[i].input.features->cells, again[i].input.features->cells);
  }
  EXPECT_NE(flown(8)[50].truth.position, flight[50].truth.position);
}

TEST_F(Flights, StepsCountUpInTimeAndOdometryWithoutErrorsLeadsFromPoseToPose) {
  plan.odometry = {0.0, Angle(), 0.0, Angle()};
  plan.handling.step_s = 0.5;
  const Flight flight = flown();
  EXPECT_FALSE(flight[0].input.odometry);
  for (std::size_t i = 1; i < flight.size(); ++i) {
    EXPECT_EQ(flight[i].input.sequence, static_cast<std::int64_t>(i));
    EXPECT_EQ(flight[i].input.time_us - flight[i - 1].input.time_us, 500'000);
    const GridPose& from = flight[i - 1].truth;
    const Odometry& told = flight[i].input.odometry.value();
    EXPECT_NEAR(flight[i].truth.position.east_m,
                from.position.east_m + told.forward_m * sin(from.heading) + told.right_m * cos(from.heading), 1e-6);
    EXPECT_NEAR(flight[i].truth.position.north_m,
                from.position.north_m + told.forward_m * cos(from.heading) - told.right_m * sin(from.heading), 1e-6);
    EXPECT_NEAR(angular_distance(flight[i].truth.heading, from.heading + told.turn).radians(), 0.0, 1e-9);
    EXPECT_LE(std::abs(told.turn.degrees()), 5.0 + 1e-9);
  }
}

TEST_F(Flights, OdometryErrorsHaveTheSizeThatWasAskedFor) {
  plan.steps = 2000;
  plan.odometry = {0.1, Angle(), 0.0, Angle()};
  double sum2 = 0.0;
  const Flight flight = flown();
  for (std::size_t i = 1; i < flight.size(); ++i) {
    const double angle = flight[i].input.odometry->turn.radians();
    const double exact = std::abs(angle) < 1e-9 ? 15.0 : 15.0 / angle * std::sin(angle);
    sum2 += std::pow(flight[i].input.odometry->forward_m - exact, 2.0);
  }
  // Of 1999 draws the standard deviation is known to 1.6 %; five times that is allowed.
  EXPECT_NEAR(std::sqrt(sum2 / 1999.0), 1.5, 0.12);
}

TEST_F(Flights, FramesAreMissingDuringAnOutageAtRandomAndBetween) {
  plan.outage = IndexRange{20, 40};
  EXPECT_EQ(frames(flown()), 80);
  plan.outage.reset();
  plan.frame_every = 4;
  EXPECT_EQ(frames(flown()), 25);
  plan.frame_every = 1;
  plan.missing_share = 0.3;
  plan.steps = 1000;
  EXPECT_NEAR(frames(flown()), 700, 5 * 14.5);  // five standard deviations of the binomial
}

TEST_F(Flights, AKidnappedVehicleIsElsewhereAndItsOdometryDoesNotTell) {
  plan.kidnapping = Kidnapping{10, 500.0};
  const Flight flight = flown();
  EXPECT_NEAR(distance_m(flight[9].truth.position, flight[10].truth.position), 500.0, 15.1);
  EXPECT_LT(distance_m(*flight[10].input.odometry), 20.0);
  EXPECT_TRUE(kBox.contains(flight[10].truth.position));
  plan.kidnapping->distance_m = 5000.0;
  EXPECT_EQ(code_of([&] { flown(); }), "kidnapping-too-far");
}

TEST_F(Flights, SeeTheGroundWhereTheMapDoesNotSayItIsByTheSameDistanceInEveryStep) {
  const auto offset_of = [&](double registration_m) {
    const Witness witness;
    plan.registration_m = registration_m;
    const auto pilot = make_random_pilot(kBox, plan.handling);
    const Flight flight = fly(plan, kBox, *pilot, witness, 5, [] {});
    const auto off = [&](std::size_t i) {
      return GridPoint{witness.places[i].east_m - flight[i].truth.position.east_m,
                       witness.places[i].north_m - flight[i].truth.position.north_m};
    };
    for (std::size_t i = 1; i < flight.size(); ++i) EXPECT_LT(distance_m(off(i), off(0)), 1e-6);
    return off(0);
  };
  EXPECT_EQ(offset_of(0.0), (GridPoint{0.0, 0.0}));
  const GridPoint once = offset_of(2.0);
  const GridPoint twice = offset_of(4.0);
  EXPECT_GT(distance_m(once, {}), 0.0);
  EXPECT_NEAR(distance_m(twice, {2.0 * once.east_m, 2.0 * once.north_m}), 0.0, 1e-6);
}

TEST_F(Flights, OfAWrongAltitudeShowGroundOfAnotherSizeByTheSameFactorInEveryStep) {
  const auto scale_of = [&](double bias) {
    const Witness witness;
    plan.altitude_bias = bias;
    const auto pilot = make_random_pilot(kBox, plan.handling);
    fly(plan, kBox, *pilot, witness, 5, [] {});
    EXPECT_THAT(witness.scales, ::testing::Each(witness.scales.front()));
    return witness.scales.front();
  };
  EXPECT_EQ(scale_of(0.0), 1.0);
  EXPECT_NE(scale_of(0.05), 1.0);
  EXPECT_NEAR(scale_of(0.1) - 1.0, 2.0 * (scale_of(0.05) - 1.0), 1e-12);
}

TEST_F(Flights, AboveTheSeaShowGroundAsLargeAsItsHeightMakesIt) {
  const testing::SlopingGround ground{kBox, 200.0, 260.0};
  plan.level = LevelFlight{std::make_shared<const Terrain>(ground.terrain()), 460.0, 250.0};
  for (const bool is_told : {true, false}) {
    plan.level->is_told = is_told;
    const Witness witness;
    const auto pilot = make_random_pilot(kBox, plan.handling);
    const Flight flight = fly(plan, kBox, *pilot, witness, 5, [] {});
    ASSERT_EQ(witness.scales.size(), flight.size());
    for (std::size_t i = 0; i < flight.size(); ++i) {
      const double agl_m = 460.0 - ground.height_m(flight[i].truth.position);
      EXPECT_NEAR(witness.scales[i], agl_m / 250.0, 0.002);
      ASSERT_TRUE(flight[i].input.altitude);
      EXPECT_EQ(flight[i].input.altitude->above_sea_m, is_told ? std::optional(460.0) : std::nullopt);
    }
  }
}

TEST_F(Flights, OdometryDoesNotFeelTheWind) {
  plan.odometry = {0.0, Angle(), 0.0, Angle(), 5.0};
  const Flight flight = flown();
  const auto blown = [&](std::size_t i) {
    const GridPoint there = moved(flight[i - 1].truth, *flight[i].input.odometry).position;
    return GridPoint{flight[i].truth.position.east_m - there.east_m, flight[i].truth.position.north_m - there.north_m};
  };
  EXPECT_GT(distance_m(blown(1), {}), 0.1);
  for (std::size_t i = 2; i < flight.size(); ++i) EXPECT_LT(distance_m(blown(i), blown(1)), 1e-6) << "step " << i;
}

TEST_F(Flights, OfWaypointsPassCloseToEachAndEndAtTheLast) {
  const std::vector<GridPoint> points{{600'600, 6'399'100}, {601'000, 6'399'100}, {601'000, 6'399'700}};
  plan.steps = 1000;
  const auto pilot = make_waypoint_pilot(points, plan.handling);
  const Flight flight = fly(plan, kBox, *pilot, sensor, 1, [] {});
  EXPECT_LT(flight.size(), 120u);
  for (const GridPoint& point : points) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const FlightStep& step : flight) nearest = std::min(nearest, distance_m(step.truth.position, point));
    EXPECT_LT(nearest, 100.0);  // the turning circle at 15 m/s and 10 deg/s has 86 m
  }
}

TEST(Pilots, SurveyLanesCoverTheBoxBackAndForth) {
  const auto lanes = survey_lanes(kBox, 400.0);
  ASSERT_EQ(lanes.size(), 6u);
  EXPECT_EQ(lanes[0], kBox.min);
  EXPECT_EQ(lanes[2].east_m, kBox.max.east_m);
  EXPECT_EQ(lanes[4].north_m, kBox.min.north_m + 800.0);
}

TEST(Area, KeepsTheMiddleOfAMapAndLeavesTheRestUnobserved) {
  const RoadGrid town = testing::street_map(3, {2.0, {300'100, -3'200'050}, 200, 200});
  const MapView part = middle_of(testing::view_of(town), 100.0);
  EXPECT_DOUBLE_EQ(part.extent.width_m(), 100.0);
  const RoadGrid grid = part.read(town.geometry);
  EXPECT_EQ(grid.cells.observed_count(), 50u * 50u);
  EXPECT_EQ(grid.cells.at(100, 100), town.cells.at(100, 100));
}

}  // namespace
}  // namespace roadfix::fly
