// Oracle: attitudes and cameras as the aerospace textbooks have them (axes x forward, y right, z down; yaw, pitch and
// roll as three rotations), written anew.
#include "core/detect/boresight.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <random>
#include <vector>

#include "core/detect/displacement.hpp"
#include "tests/core/detect/level_camera.hpp"

namespace roadfix {
namespace {

using testing::kFrame;
using testing::level_camera;

cv::Matx33d textbook(const Attitude& a) {
  const double cy = cos(a.yaw), sy = sin(a.yaw), cp = cos(a.pitch), sp = sin(a.pitch), cr = cos(a.roll),
               sr = sin(a.roll);
  return cv::Matx33d(cy, -sy, 0, sy, cy, 0, 0, 0, 1) * cv::Matx33d(cp, 0, sp, 0, 1, 0, -sp, 0, cp) *
         cv::Matx33d(1, 0, 0, 0, cr, -sr, 0, sr, cr);
}

Attitude degrees(double yaw, double pitch, double roll) {
  return {Angle::degrees(yaw), Angle::degrees(pitch), Angle::degrees(roll)};
}

/// Forward and right of the nadir, from a height of 1, of a pixel of level_camera().
cv::Point2d textbook_ground(const Attitude& attitude, cv::Point2d pixel) {
  const cv::Vec3d ray((240.0 - pixel.y) / 320.0, (pixel.x - 320.0) / 320.0, 1.0);  // 90 degrees across
  const cv::Vec3d at = textbook(attitude) * ray;
  return {at[0] / at[2], at[1] / at[2]};
}

TEST(MountedAttitude, IsTheMountInTheAxesOfItsCarrier) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> any(-60.0, 60.0);
  for (int i = 0; i < 100; ++i) {
    const Attitude carrier = degrees(3.0 * any(random), any(random), any(random));
    const Attitude mount = degrees(any(random), 0.2 * any(random), 0.2 * any(random));
    const cv::Matx33d expected = textbook(carrier) * textbook(mount);
    EXPECT_LT(cv::norm(textbook(mounted(carrier, mount)) - expected), 1e-12);
  }
}

class DisplacementOfAFrame : public ::testing::Test {
 protected:
  DisplacementOfAFrame() {
    camera.pitch = told.pitch;
    camera.roll = told.roll;
  }
  /// How far apart ground as placed, moved by the displacement, and where it is lie, over the frame.
  double distance(const Displacement& by) const {
    double sum = 0.0;
    for (double y = 0.0; y <= 480.0; y += 48.0) {
      for (double x = 0.0; x <= 640.0; x += 64.0) {
        const cv::Point2d placed = 100.0 * textbook_ground(told, {x, y});
        if (cv::norm(placed) > farthest_m) continue;
        const double c = by.size * cos(by.offset.turn), s = by.size * sin(by.offset.turn);
        const cv::Point2d moved(by.offset.forward_m + c * placed.x - s * placed.y,
                                by.offset.right_m + s * placed.x + c * placed.y);
        const cv::Point2d apart = moved - 100.0 * higher * textbook_ground(actual, {x, y});
        sum += apart.dot(apart);
      }
    }
    return sum;
  }

  /// By as much as 1 degree moves ground by 10 m.
  const double farthest_m = std::sqrt(10.0 * 100.0 / (M_PI / 180.0));
  Attitude told = degrees(0.0, 10.0, -4.0);
  Attitude actual = degrees(3.0, 12.0, -7.0);
  double higher = 1.04;
  FrameCamera camera = level_camera();
};

TEST_F(DisplacementOfAFrame, BringsNoPlacedGroundNearerToWhereItIsIfChanged) {
  const Displacement best = PlacedFrame(camera, kFrame).seen_by(actual, higher);
  const double least = distance(best);
  EXPECT_LT(least / 121.0, 5.0 * 5.0) << "squared metres, of 14 that the ground ahead is displaced";
  for (const double sign : {-1.0, 1.0}) {
    for (const Displacement& step :
         {Displacement{{0.01, 0, {}}, 0}, {{0, 0.01, {}}, 0}, {{0, 0, Angle::radians(1e-4)}, 0}, {{}, 1e-4}}) {
      Displacement other = best;
      other.offset.forward_m += sign * step.offset.forward_m;
      other.offset.right_m += sign * step.offset.right_m;
      other.offset.turn += sign * step.offset.turn;
      other.size += sign * step.size;
      EXPECT_GT(distance(other), least);
    }
  }
}

TEST_F(DisplacementOfAFrame, IsNoneOfACameraThatIsToldRightly) {
  const Displacement none = PlacedFrame(camera, kFrame).seen_by(told, 1.0);
  EXPECT_NEAR(none.offset.forward_m, 0.0, 1e-9);
  EXPECT_NEAR(none.offset.right_m, 0.0, 1e-9);
  EXPECT_NEAR(none.offset.turn.radians(), 0.0, 1e-12);
  EXPECT_NEAR(none.size, 1.0, 1e-12);
}

/// A flight whose frames are found where its camera, its delay and the map have them, with errors of 3 m and 0.3
/// degrees.
struct SimulatedFlight {
  int frames = 40;
  Attitude mount = degrees(3.0, 2.0, -1.5);
  double size = 1.03;
  double delay_s = 0.0;
  GridPoint map_off{};
  double heading_range_deg = 360.0;
  std::vector<double> speeds_m_s{0.0};
  double agl_m = 300.0;
  double lean_deg = 5.0;  // 1 sigma
  double told_roll_sign = 1.0;
  double told_pitch_sign = 1.0;

  std::vector<BoresightSighting> fly(std::uint64_t seed) const {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> share(0.0, 1.0);
    std::vector<BoresightSighting> sightings;
    for (int i = 0; i < frames; ++i) {
      BoresightSighting seen;
      seen.frame = kFrame;
      const Attitude body = degrees(0.0, lean_deg * normal(random), lean_deg * normal(random));
      FrameCamera right = level_camera();
      right.agl_m = agl_m;
      seen.camera = right;
      seen.camera.pitch = told_pitch_sign * body.pitch;
      seen.camera.roll = told_roll_sign * body.roll;
      seen.told = {{500'000.0 + 100.0 * i, 4'000'000.0}, Angle::degrees(heading_range_deg * share(random))};
      const double speed = speeds_m_s[static_cast<std::size_t>(i) % speeds_m_s.size()];
      seen.velocity_m_s = GridPoint{speed * sin(seen.told.heading), speed * cos(seen.told.heading)};
      const auto displaced = PlacedFrame(seen.camera, kFrame).seen_by(mounted(body, mount), size);
      seen.found = moved(seen.told, displaced.offset);
      seen.found.position.east_m += map_off.east_m - delay_s * seen.velocity_m_s->east_m + 3.0 * normal(random);
      seen.found.position.north_m += map_off.north_m - delay_s * seen.velocity_m_s->north_m + 3.0 * normal(random);
      seen.found.heading += Angle::degrees(0.3 * normal(random));
      seen.size = displaced.size * (1.0 + 0.01 * normal(random));
      sightings.push_back(seen);
    }
    return sightings;
  }
};

double sigmas_off(const Estimate& found, double truth) { return std::abs(found.value - truth) / found.sigma; }

TEST(BoresightOfAFlight, IsTheMountOfTheCameraWithItsError) {
  const SimulatedFlight flight{.map_off = {2.0, -3.0}};
  double squares = 0.0;
  constexpr int kFlights = 30;
  for (int i = 0; i < kFlights; ++i) {
    const Boresight found = boresight_of(flight.fly(static_cast<std::uint64_t>(i)), {});
    for (const double off : {sigmas_off(found.yaw_deg, 3.0), sigmas_off(found.pitch_deg, 2.0),
                             sigmas_off(found.roll_deg, -1.5), sigmas_off(found.size, 1.03)}) {
      EXPECT_LT(off, 4.0);
      squares += off * off;
    }
    EXPECT_LT(found.pitch_deg.sigma, 0.25);
    EXPECT_LT(found.yaw_deg.sigma, 0.25);
    EXPECT_NEAR(found.corrected_rms_m, 3.0 * std::sqrt(2.0), 1.5);
    EXPECT_GT(found.told_rms_m, 10.0);
    EXPECT_NEAR(found.attitude_sigma.degrees(), 3.0 / 300.0 * 180.0 / M_PI, 0.2) << "of errors of 3 m";
    EXPECT_NEAR(found.east_m.value, 2.0, 2.0);
    EXPECT_FALSE(found.is_roll_reversed);
    EXPECT_FALSE(found.is_pitch_reversed);
  }
  // The mean of 120 squares, of which the allowance for distortion makes less than 1; 1.5 is four deviations above.
  EXPECT_LT(squares / (4.0 * kFlights), 1.5);
  EXPECT_GT(squares / (4.0 * kFlights), 0.3);
}

TEST(BoresightOfAFlight, LeavesOutFramesThatLieElsewhere) {
  std::vector<BoresightSighting> sightings = SimulatedFlight{}.fly(1);
  for (std::size_t i = 0; i < sightings.size(); i += 5) sightings[i].found.position.east_m += 60.0;
  const Boresight found = boresight_of(sightings, {});
  EXPECT_EQ(found.used_count(), 32U);
  EXPECT_LT(sigmas_off(found.pitch_deg, 2.0), 4.0);
  EXPECT_LT(sigmas_off(found.roll_deg, -1.5), 4.0);
}

TEST(BoresightOfAFlight, IsAsSureAsWithoutFramesThatLieElsewhere) {
  double squares = 0.0;
  constexpr int kFlights = 20;
  for (int flight = 0; flight < kFlights; ++flight) {
    std::vector<BoresightSighting> all = SimulatedFlight{}.fly(static_cast<std::uint64_t>(flight));
    std::vector<BoresightSighting> right;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (i % 5 == 0) {
        all[i].found.position.east_m += 60.0;
      } else {
        right.push_back(all[i]);
      }
    }
    const Boresight found = boresight_of(all, {});
    const Boresight without = boresight_of(right, {});
    ASSERT_EQ(found.used_count(), without.used_count());
    EXPECT_NEAR(found.pitch_deg.sigma / without.pitch_deg.sigma, 1.0, 0.1) << flight;
    EXPECT_NEAR(found.east_m.sigma / without.east_m.sigma, 1.0, 0.1) << flight;
    EXPECT_NEAR(found.size.sigma / without.size.sigma, 1.0, 0.1) << flight;
    for (const double off : {sigmas_off(found.pitch_deg, 2.0), sigmas_off(found.roll_deg, -1.5),
                             sigmas_off(found.east_m, 0.0), sigmas_off(found.north_m, 0.0)}) {
      squares += off * off;
    }
  }
  EXPECT_LT(squares / (4.0 * kFlights), 1.6) << "four deviations above 1";
}

TEST(BoresightOfAFlight, DoesNotTellAMountFromAMapThatIsOffWhereAllHeadingsAreAlike) {
  const Boresight one =
      boresight_of(SimulatedFlight{.heading_range_deg = 1.0, .lean_deg = 0.5}.fly(2), {.place_sigma_m = 4.0});
  const Boresight all = boresight_of(SimulatedFlight{.lean_deg = 0.5}.fly(2), {.place_sigma_m = 4.0});
  EXPECT_GT(one.pitch_deg.sigma, 0.7 * 4.0 / 300.0 * 180.0 / M_PI);
  EXPECT_LT(all.pitch_deg.sigma, 0.25);
  EXPECT_GT(one.attitude_sigma.degrees(), one.pitch_deg.sigma) << "on a flight with another heading it shows";
}

TEST(BoresightOfAFlight, TellsADelayFromAMountByDifferentSpeedsOnly) {
  const SimulatedFlight steady{.delay_s = 0.4, .speeds_m_s = {20.0}, .lean_deg = 0.5};
  SimulatedFlight changing = steady;
  changing.speeds_m_s = {5.0, 25.0};
  const BoresightPrior prior{.delay_sigma_s = 1.0};
  const Boresight one = boresight_of(steady.fly(3), prior);
  EXPECT_GT(one.delay_s.value().sigma, 0.5);
  EXPECT_GT(one.pitch_deg.sigma, 1.5) << "20 m, which are 4 degrees, for each second";
  const Boresight two = boresight_of(changing.fly(3), prior);
  EXPECT_LT(two.delay_s.value().sigma, 0.1);
  EXPECT_LT(sigmas_off(*two.delay_s, 0.4), 4.0);
  EXPECT_LT(sigmas_off(two.pitch_deg, 2.0), 4.0);
}

TEST(BoresightOfAFlight, SaysWhichAngleIsToldWithTheWrongSign) {
  const Boresight roll = boresight_of(SimulatedFlight{.frames = 12, .told_roll_sign = -1.0}.fly(4), {});
  EXPECT_TRUE(roll.is_roll_reversed);
  EXPECT_FALSE(roll.is_pitch_reversed);
  EXPECT_LT(sigmas_off(roll.roll_deg, -1.5), 4.0);
  const Boresight pitch = boresight_of(SimulatedFlight{.frames = 12, .told_pitch_sign = -1.0}.fly(5), {});
  EXPECT_FALSE(pitch.is_roll_reversed);
  EXPECT_TRUE(pitch.is_pitch_reversed);
}

TEST(BoresightOfAFlight, OfACameraThatNeverLeansSaysNothingOfSigns) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Boresight found = boresight_of(SimulatedFlight{.frames = 8, .lean_deg = 0.1}.fly(seed), {});
    EXPECT_FALSE(found.is_roll_reversed || found.is_pitch_reversed);
  }
}

}  // namespace
}  // namespace roadfix
