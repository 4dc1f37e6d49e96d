// Monte Carlo localization (docs/method.md): particles that are moved, weighted and drawn anew. Knows no map:
// whoever weights the particles says how likely the measurement is from each of them.
//
// The same seed and inputs give the same particles, with any number of threads.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/filter/motion.hpp"
#include "core/filter/particles.hpp"
#include "core/filter/ranges.hpp"
#include "core/filter/region.hpp"
#include "core/filter/resampling.hpp"

namespace roadfix {

enum class Injection {
  kFixedShare,          ///< the paper: a fixed share is drawn uniformly in every step
  kLikelihoodAverages,  ///< as much as the measurements of late fit worse than they used to (Thrun et al.,
                        ///< Probabilistic Robotics, table 8.3)
};

struct FilterOptions {
  int min_particles = 1'000;
  int max_particles = 10'000;
  bool adapts_count = true;      ///< by KLD sampling; else always max_particles
  double effective_share = 0.5;  ///< resample when fewer are effective; 1 = after every measurement
  Injection injection = Injection::kLikelihoodAverages;
  double injected_share = 0.15;  ///< of kFixedShare; the most of kLikelihoodAverages
  double roughening_m = 1.0;     ///< 1 sigma by which copies of a particle are moved apart
  Angle roughening_heading = Angle::degrees(0.5);
  double least_kept = 0.5;  ///< of the weight, when particles leave the region: with less the belief is thrown away

  /// The paper's: a fixed number, resampling after every measurement, 15 % drawn uniformly in every step, copies stay
  /// copies, and however many particles leave the region, the others go on.
  static FilterOptions paper(int particles);
};

/// A place that a search found, to draw particles around.
struct Proposal {
  GridPose mean;
  PoseCovariance covariance{};
  double weight = 1.0;
  double log_scale = 0.0;
  double log_scale_sigma = 0.0;
};

/// All that a filter is between two steps.
struct FilterState {
  Particles particles;
  std::uint64_t seed = 0;
  std::uint64_t step = 0;    ///< predictions and draws so far: addresses the random numbers
  std::uint64_t resets = 0;  ///< times that the belief was thrown away
  double slow_fit = 0.5;     ///< averages of how well measurements fit the belief, 0 to 1
  double fast_fit = 0.5;
  friend bool operator==(const FilterState&, const FilterState&) = default;
};

/// The mean of likelihoods up to its exponential is a finite number.
inline constexpr double kMaxLogLikelihood = 700.0;

struct Correction {
  /// Mean likelihood under the belief. Where likelihoods are ratios to chance, 1 says that the measurement fits the
  /// belief as well as any place.
  double mean_likelihood = 0.0;
  bool usable = false;  ///< some particle could explain the measurement; else the weights stay
  bool resampled = false;
};

class Filter {
 public:
  Filter(const FilterOptions& options, const AcceptanceRegion& region, std::uint64_t seed, int threads = 1);
  Filter(const FilterOptions& options, const AcceptanceRegion& region, FilterState state, int threads = 1);

  /// The uniform belief of the paper over a region. Counts as a reset unless it is the first.
  void start_uniformly(const PoseRegion& over);
  /// Draws around the proposals by their weights, and the rest uniformly. Counts as start_uniformly() does.
  void start_anew_from(std::span<const Proposal> proposals, double uniform_share, const PoseRegion& over);
  /// The same where a search tells more about a belief that has just begun: not a reset.
  void redraw_from(std::span<const Proposal> proposals, double uniform_share, const PoseRegion& over);

  /// Moves the particles; those that the region does not keep lose their weight. Returns the share of the weight that
  /// it keeps: 0 where that was less than FilterOptions::least_kept, or nothing, and the belief became uniform over the
  /// region.
  template <MotionModel Motion>
  double predict(const Motion& motion) {
    begin_step();
    Particles& particles = state_.particles;
    for_ranges(particles.size(), threads_, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        RandomStream random(Draw::kMotion, {state_.seed, state_.step, i});
        ParticleState moved = particles.at(i);
        motion(moved, random);
        particles.set(i, moved);
      }
    });
    return keep_within_region();
  }

  /// Weights the particles by the measurement's log-likelihood from each of them, in [-inf, kMaxLogLikelihood] with
  /// -inf = impossible, then resamples as the options say.
  Correction correct(std::span<const double> log_likelihoods);

  /// Replaces a share of the particles by draws around the proposals.
  void inject(std::span<const Proposal> proposals, double share);
  /// Moves each particle by a normal draw of this sigma per axis, where the motion was told better than it is.
  void widen(double sigma_m);
  /// Changes the drift of each particle by a normal draw of this sigma per axis, and draws new ones with as much.
  void widen_drift(double sigma_m_s);
  /// Changes the drift of a share of the particles, drawn at random, by a normal draw of this sigma per axis.
  void try_drifts(double share, double sigma_m_s);
  /// How much worse late measurements fit than earlier ones, in [0, 1].
  double doubt() const;

  const Particles& particles() const { return state_.particles; }
  const FilterState& state() const { return state_; }

 private:
  void begin_step();
  double keep_within_region();
  void resample();
  void roughen(std::span<const std::size_t> ancestors);
  /// Adds noise to two columns of a share of the particles, drawn at random.
  void scatter(std::vector<double>& east, std::vector<double>& north, double sigma, Draw purpose, double share = 1.0);
  double share_to_inject() const;
  template <typename DrawState>
  void replace_some(std::size_t count, DrawState draw);

  FilterOptions options_;
  AcceptanceRegion region_;
  int threads_;
  FilterState state_;
  bool started_ = false;
};

}  // namespace roadfix
