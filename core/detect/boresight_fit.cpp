#include "core/detect/boresight_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace roadfix::boresight {
namespace {

/// Found east and north (m), turn (rad) and size (ln).
constexpr int kMeasurements = 4;
using Measured = cv::Vec<double, kMeasurements>;
using Slopes = cv::Matx<double, kMeasurements, kParameters>;

double place_m(const Measured& measured) { return std::hypot(measured[0], measured[1]); }

/// What was measured beyond what the parameters explain.
Measured residual_of(const PlacedSighting& sighting, const Signs& signs, const Parameters& at) {
  const BoresightSighting& seen = *sighting.seen;
  const Attitude told{Angle(), signs.pitch * seen.camera.assumed_pitch(), signs.roll * seen.camera.assumed_roll()};
  const Attitude mount{Angle::radians(at[kYaw]), Angle::radians(at[kPitch]), Angle::radians(at[kRoll])};
  const Displacement explained = sighting.placed.seen_by(mounted(told, mount), std::exp(at[kHigher]));
  const GridPose expected = moved(seen.told, explained.offset);
  const GridPoint v = seen.velocity_m_s.value_or(GridPoint{});
  return {seen.found.position.east_m - expected.position.east_m + v.east_m * at[kDelay] - at[kEast],
          seen.found.position.north_m - expected.position.north_m + v.north_m * at[kDelay] - at[kNorth],
          (seen.found.heading - expected.heading).wrapped().radians(), std::log(seen.size / explained.size)};
}

Slopes slopes_of(const PlacedSighting& seen, const Signs& signs, const Parameters& at) {
  constexpr double kStep = 1e-4;  // of any unit: what is not linear in the parameters are angles and logarithms
  Slopes slopes;
  for (int i = 0; i < kParameters; ++i) {
    Parameters step = Parameters::all(0.0);
    step[i] = kStep;
    const Measured rise = residual_of(seen, signs, at + step) - residual_of(seen, signs, at - step);
    for (int m = 0; m < kMeasurements; ++m) slopes(m, i) = rise[m] / (2.0 * kStep);
  }
  return slopes;
}

Covariance information_in(const BoresightPrior& prior) {
  constexpr double kAngleSigma = 0.35;  // rad: more is no misalignment, but another mount
  constexpr double kHigherSigma = 0.2;
  const Parameters sigma(kAngleSigma, kAngleSigma, kAngleSigma, kHigherSigma, prior.delay_sigma_s, prior.place_sigma_m,
                         prior.place_sigma_m);
  Covariance information = Covariance::zeros();
  for (int i = 0; i < kParameters; ++i) information(i, i) = 1.0 / (sigma[i] * sigma[i]);
  return information;
}

class Fitting {
 public:
  Fitting(std::span<const PlacedSighting> sightings, const BoresightPrior& prior, const Signs& signs)
      : sightings_(sightings), prior_information_(information_in(prior)) {
    fit_.signs = signs;
    fit_.used.assign(sightings.size(), true);
  }

  Fit fit() {
    constexpr int kRounds = 10;
    for (int round = 0; round < kRounds; ++round) {
      for (int step = 0; step < 4; ++step) improve();
      take_residuals();
      const std::vector<bool> before = fit_.used;
      leave_out_those_elsewhere();
      sigma_ = scatter();
      if (round > 0 && fit_.used == before) break;
    }
    improve();  // by the scatter of those that are left
    take_residuals();
    return fit_;
  }

 private:
  /// A step of Gauss and Newton.
  void improve() {
    Covariance information = prior_information_;
    Parameters gradient = information * fit_.at;
    const auto weight = cv::Matx<double, kMeasurements, kMeasurements>::diag(
        {1.0 / (sigma_[0] * sigma_[0]), 1.0 / (sigma_[1] * sigma_[1]), 1.0 / (sigma_[2] * sigma_[2]),
         1.0 / (sigma_[3] * sigma_[3])});
    for (std::size_t i = 0; i < sightings_.size(); ++i) {
      if (!fit_.used[i]) continue;
      const Slopes slopes = slopes_of(sightings_[i], fit_.signs, fit_.at);
      information += slopes.t() * weight * slopes;
      gradient += slopes.t() * weight * residual_of(sightings_[i], fit_.signs, fit_.at);
    }
    fit_.covariance = information.inv(cv::DECOMP_CHOLESKY);
    fit_.at -= fit_.covariance * gradient;
  }

  void take_residuals() {
    residuals_.clear();
    fit_.left_m.clear();
    for (const PlacedSighting& seen : sightings_) {
      residuals_.push_back(residual_of(seen, fit_.signs, fit_.at));
      fit_.left_m.push_back(place_m(residuals_.back()));
    }
  }

  /// Of those in use; the parameters have taken some of it.
  Measured scatter() const {
    const Measured least(0.5, 0.5, 0.001, 0.002);
    double places = 0.0;
    Measured squares = Measured::all(0.0);
    for (std::size_t i = 0; i < residuals_.size(); ++i) {
      if (!fit_.used[i]) continue;
      squares += residuals_[i].mul(residuals_[i]);
      places += 1.0;
    }
    const double place = std::sqrt((squares[0] + squares[1]) / std::max(1.0, 2.0 * places - 5.0));
    const double others = std::max(1.0, places - 1.0);
    const Measured found(place, place, std::sqrt(squares[2] / others), std::sqrt(squares[3] / others));
    Measured sigma;
    for (int m = 0; m < kMeasurements; ++m) sigma[m] = std::max(found[m], least[m]);
    return sigma;
  }

  /// The median hardly depends on them.
  void leave_out_those_elsewhere() {
    constexpr double kMedianOfRayleigh = 1.1774;  // of the length of a vector whose parts have a deviation of 1
    constexpr double kFarthest = 4.0;
    const double limit_m = kFarthest * std::max(1.0, fit_.median_left_m() / kMedianOfRayleigh);
    for (std::size_t i = 0; i < fit_.used.size(); ++i) fit_.used[i] = fit_.left_m[i] <= limit_m;
  }

  std::span<const PlacedSighting> sightings_;
  Covariance prior_information_;
  Measured sigma_{5.0, 5.0, 0.01, 0.01};
  std::vector<Measured> residuals_;
  Fit fit_;
};

}  // namespace

double Fit::median_left_m() const {
  std::vector<double> sorted = left_m;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::ranges::nth_element(sorted, middle);
  return *middle;
}

std::vector<PlacedSighting> placed_sightings(std::span<const BoresightSighting> sightings) {
  std::vector<PlacedSighting> placed;
  placed.reserve(sightings.size());
  for (const BoresightSighting& seen : sightings) placed.push_back({&seen, PlacedFrame(seen.camera, seen.frame)});
  return placed;
}

Fit fit_of(std::span<const PlacedSighting> sightings, const BoresightPrior& prior, const Signs& signs) {
  return Fitting(sightings, prior, signs).fit();
}

}  // namespace roadfix::boresight
