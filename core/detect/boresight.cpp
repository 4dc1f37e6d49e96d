#include "core/detect/boresight.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/detect/boresight_fit.hpp"

namespace roadfix {
namespace {

using boresight::Fit;
using boresight::Parameter;
using boresight::Signs;

/// The signs as told, unless others explain the places so much better that chance would hardly do (a likelihood ratio
/// of a thousand; a sighting has two coordinates).
Fit best_fit(std::span<const BoresightSighting> seen, const BoresightPrior& prior) {
  const std::vector<boresight::PlacedSighting> sightings = boresight::placed_sightings(seen);
  constexpr double kLeastM = 0.1;  // less is no error of a match
  const auto unlikelihood = [&](const Fit& fit) {
    return 2.0 * static_cast<double>(sightings.size()) * std::log(std::max(kLeastM, fit.median_left_m()));
  };
  Fit best = fit_of(sightings, prior, Signs{});
  double to_beat = unlikelihood(best) - std::log(1000.0);
  for (const Signs& signs : {Signs{-1.0, 1.0}, Signs{1.0, -1.0}, Signs{-1.0, -1.0}}) {
    Fit fit = fit_of(sightings, prior, signs);
    if (unlikelihood(fit) >= to_beat) continue;
    to_beat = unlikelihood(fit);
    best = std::move(fit);
  }
  return best;
}

/// A camera that is turned distorts the ground, too, which a match weighs by the roads that it finds there, and a
/// similarity by area: measured as a twentieth of the angle.
Estimate angle_of(const Fit& fit, Parameter i) {
  constexpr double kDegree = 180.0 / std::numbers::pi;
  constexpr double kDistorted = 0.05;
  return {fit.at[i] * kDegree, std::hypot(std::sqrt(fit.covariance(i, i)), kDistorted * fit.at[i]) * kDegree};
}

/// By which a camera has to turn for the place to move so far.
Angle angle_by(const FrameCamera& camera, double moved_m) {
  const double steep = level_from_camera(camera)(2, 2);
  return Angle::radians(moved_m * steep * steep / camera.agl_m);
}

double square(double value) { return value * value; }

}  // namespace

Boresight boresight_of(std::span<const BoresightSighting> sightings, const BoresightPrior& prior) {
  const Fit fit = best_fit(sightings, prior);
  const auto estimate = [&](Parameter i) { return Estimate{fit.at[i], std::sqrt(fit.covariance(i, i))}; };
  Boresight found;
  found.yaw_deg = angle_of(fit, boresight::kYaw);
  found.pitch_deg = angle_of(fit, boresight::kPitch);
  found.roll_deg = angle_of(fit, boresight::kRoll);
  const Estimate higher = estimate(boresight::kHigher);
  found.size = {std::exp(higher.value), std::exp(higher.value) * higher.sigma};
  if (std::ranges::any_of(sightings, [](const auto& seen) { return seen.velocity_m_s.has_value(); })) {
    found.delay_s = estimate(boresight::kDelay);
  }
  found.east_m = estimate(boresight::kEast);
  found.north_m = estimate(boresight::kNorth);
  found.is_roll_reversed = fit.signs.roll < 0.0;
  found.is_pitch_reversed = fit.signs.pitch < 0.0;
  found.used = fit.used;
  double told = 0.0;
  double left = 0.0;
  double turned = 0.0;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    if (!fit.used[i]) continue;
    const double angle = angle_by(sightings[i].camera, fit.left_m[i]).radians();
    told += square(distance_m(sightings[i].told.position, sightings[i].found.position));
    left += square(fit.left_m[i]);
    turned += square(angle);
  }
  const auto used = static_cast<double>(found.used_count());
  found.told_rms_m = std::sqrt(told / used);
  found.corrected_rms_m = std::sqrt(left / used);
  const Angle scatter = Angle::radians(std::sqrt(turned / (2.0 * used)));
  const double mount_deg = std::max(found.pitch_deg.sigma, found.roll_deg.sigma);
  found.attitude_sigma = Angle::degrees(std::hypot(scatter.degrees(), mount_deg));
  return found;
}

}  // namespace roadfix
