#include "core/filter/filter.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <utility>

namespace roadfix {
namespace {

// Of the averages of how well measurements fit the belief.
constexpr double kSlowRate = 0.02;
constexpr double kFastRate = 0.2;
constexpr double kCalmDoubt = 0.15;  // below it doubt is but their fluctuation, and nothing is drawn anew

constexpr double kRougheningLogScale = 0.003;  // where the region leaves the scale open

/// Returns false, and leaves the weights, where they sum to nothing.
bool normalise(std::vector<double>& weights) {
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  if (!(sum > 0.0)) return false;
  for (double& w : weights) w /= sum;
  return true;
}

class ProposalDraw {
 public:
  ProposalDraw(std::span<const Proposal> proposals, const AcceptanceRegion& region)
      : proposals_(proposals), region_(region) {
    for (const Proposal& proposal : proposals) {
      total_ += proposal.weight;
      const auto factor = cholesky(proposal.covariance);
      assert(factor);
      factors_.push_back(*factor);
    }
  }

  ParticleState operator()(RandomStream& random) const {
    double left = total_ * random.uniform();
    std::size_t k = 0;
    while (k + 1 < proposals_.size() && left >= proposals_[k].weight) left -= proposals_[k++].weight;
    const GridPose& mean = proposals_[k].mean;
    const Matrix3& l = factors_[k];
    const double a = random.normal();
    const double b = random.normal();
    const double c = random.normal();
    ParticleState state{mean.position.east_m + l[0][0] * a, mean.position.north_m + l[1][0] * a + l[1][1] * b,
                        (mean.heading + Angle::radians(l[2][0] * a + l[2][1] * b + l[2][2] * c)).wrapped().radians()};
    const double log_scale = proposals_[k].log_scale + proposals_[k].log_scale_sigma * random.normal();
    state.log_scale = std::clamp(log_scale, -region_.max_log_scale, region_.max_log_scale);
    draw_drift(region_, state, random);
    return state;
  }

 private:
  std::span<const Proposal> proposals_;
  const AcceptanceRegion& region_;
  std::vector<Matrix3> factors_;
  double total_ = 0.0;
};

}  // namespace

FilterOptions FilterOptions::paper(int particles) {
  FilterOptions options;
  options.min_particles = particles;
  options.max_particles = particles;
  options.adapts_count = false;
  options.effective_share = 1.0;
  options.injection = Injection::kFixedShare;
  options.roughening_m = 0.0;
  options.roughening_heading = Angle();
  options.least_kept = 0.0;
  return options;
}

Filter::Filter(const FilterOptions& options, const AcceptanceRegion& region, std::uint64_t seed, int threads)
    : options_(options), region_(region), threads_(threads) {
  state_.seed = seed;
}

Filter::Filter(const FilterOptions& options, const AcceptanceRegion& region, FilterState state, int threads)
    : options_(options), region_(region), threads_(threads), state_(std::move(state)), started_(true) {}

void Filter::start_uniformly(const PoseRegion& over) { start_anew_from({}, 1.0, over); }

void Filter::start_anew_from(std::span<const Proposal> proposals, double uniform_share, const PoseRegion& over) {
  if (std::exchange(started_, true)) ++state_.resets;
  redraw_from(proposals, uniform_share, over);
}

void Filter::redraw_from(std::span<const Proposal> proposals, double uniform_share, const PoseRegion& over) {
  ++state_.step;
  state_.slow_fit = state_.fast_fit = 0.5;
  const ProposalDraw around(proposals, region_);
  const auto count = static_cast<std::size_t>(options_.max_particles);
  const auto uniform = proposals.empty() ? count : static_cast<std::size_t>(uniform_share * static_cast<double>(count));
  state_.particles.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    RandomStream random(Draw::kStart, {state_.seed, state_.step, i});
    state_.particles.set(i, i < uniform ? uniform_draw(region_, over, random) : around(random));
    state_.particles.weight[i] = 1.0 / static_cast<double>(count);
  }
}

void Filter::begin_step() {
  assert(started_);
  ++state_.step;
  if (options_.injection != Injection::kFixedShare) return;
  const auto count = static_cast<double>(state_.particles.size());
  replace_some(static_cast<std::size_t>(options_.injected_share * count),
               [this](RandomStream& random) { return uniform_draw(region_, region_.poses, random); });
}

double Filter::keep_within_region() {
  Particles& p = state_.particles;
  double lost = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (!region_.keeps({p.east_m[i], p.north_m[i]})) lost += std::exchange(p.weight[i], 0.0);
  }
  // Those that lag behind a vehicle that has left are no belief.
  if (lost <= 1.0 - options_.least_kept && normalise(p.weight)) return 1.0 - lost;
  start_uniformly(region_.poses);
  return 0.0;
}

Correction Filter::correct(std::span<const double> log_likelihoods) {
  Particles& p = state_.particles;
  assert(log_likelihoods.size() == p.size());
  assert(std::ranges::all_of(log_likelihoods, [](double x) { return x <= kMaxLogLikelihood; }));
  Correction result;
  const double largest = *std::ranges::max_element(log_likelihoods);
  if (!std::isfinite(largest)) return result;
  std::vector<double> weights(p.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    weights[i] = p.weight[i] * std::exp(log_likelihoods[i] - largest);
    sum += weights[i];
  }
  if (!normalise(weights)) return result;
  p.weight = std::move(weights);
  result.usable = true;
  result.mean_likelihood = sum * std::exp(largest);
  // Odds of the belief against chance, as a probability: one lucky or useless frame cannot swamp the averages.
  const double fit = result.mean_likelihood / (1.0 + result.mean_likelihood);
  state_.slow_fit += kSlowRate * (fit - state_.slow_fit);
  state_.fast_fit += kFastRate * (fit - state_.fast_fit);
  const double effective = effective_sample_size(p.weight) / static_cast<double>(p.size());
  result.resampled =
      options_.effective_share >= 1.0 || effective < options_.effective_share || share_to_inject() > 0.01;
  if (result.resampled) resample();
  return result;
}

double Filter::doubt() const { return std::clamp(1.0 - state_.fast_fit / state_.slow_fit, 0.0, 1.0); }

double Filter::share_to_inject() const {
  if (options_.injection == Injection::kFixedShare) return 0.0;
  return std::clamp(doubt() - kCalmDoubt, 0.0, options_.injected_share);
}

void Filter::resample() {
  ++state_.step;
  Particles& p = state_.particles;
  RandomStream random(Draw::kResample, {state_.seed, state_.step, 0});
  const double offset = random.uniform();
  auto count = static_cast<std::size_t>(options_.max_particles);
  std::vector<std::size_t> ancestors = systematic_ancestors(p.weight, count, offset);
  if (options_.adapts_count) {
    const double wanted = kld_sample_count(occupied_bins(p, ancestors));
    count = static_cast<std::size_t>(
        std::clamp(std::ceil(wanted), static_cast<double>(options_.min_particles), static_cast<double>(count)));
    if (count != ancestors.size()) ancestors = systematic_ancestors(p.weight, count, offset);
  }
  Particles drawn;
  drawn.resize(count);
  for (std::size_t k = 0; k < count; ++k) {
    drawn.set(k, p.at(ancestors[k]));
    drawn.weight[k] = 1.0 / static_cast<double>(count);
  }
  p = std::move(drawn);
  roughen(ancestors);
  replace_some(static_cast<std::size_t>(share_to_inject() * static_cast<double>(count)),
               [this](RandomStream& stream) { return uniform_draw(region_, region_.poses, stream); });
}

void Filter::roughen(std::span<const std::size_t> ancestors) {
  if (options_.roughening_m <= 0.0) return;
  Particles& p = state_.particles;
  for (std::size_t k = 1; k < ancestors.size(); ++k) {
    if (ancestors[k] != ancestors[k - 1]) continue;
    RandomStream random(Draw::kRoughen, {state_.seed, state_.step, k});
    p.east_m[k] += options_.roughening_m * random.normal();
    p.north_m[k] += options_.roughening_m * random.normal();
    const double turn = options_.roughening_heading.radians() * random.normal();
    p.heading_rad[k] = Angle::radians(p.heading_rad[k] + turn).wrapped().radians();
    const double log_scale = p.log_scale[k] + kRougheningLogScale * random.normal();
    p.log_scale[k] = std::clamp(log_scale, -region_.max_log_scale, region_.max_log_scale);
  }
}

void Filter::widen(double sigma_m) {
  scatter(state_.particles.east_m, state_.particles.north_m, sigma_m, Draw::kRoughen);
}

void Filter::widen_drift(double sigma_m_s) {
  region_.drift_sigma_m_s = sigma_m_s;
  scatter(state_.particles.drift_east_m_s, state_.particles.drift_north_m_s, sigma_m_s, Draw::kDrift);
}

void Filter::try_drifts(double share, double sigma_m_s) {
  scatter(state_.particles.drift_east_m_s, state_.particles.drift_north_m_s, sigma_m_s, Draw::kDrift, share);
}

void Filter::scatter(std::vector<double>& east, std::vector<double>& north, double sigma, Draw purpose, double share) {
  ++state_.step;
  for (std::size_t k = 0; k < east.size(); ++k) {
    RandomStream random(purpose, {state_.seed, state_.step, k});
    if (share < 1.0 && random.uniform() >= share) continue;
    east[k] += sigma * random.normal();
    north[k] += sigma * random.normal();
  }
}

void Filter::inject(std::span<const Proposal> proposals, double share) {
  if (proposals.empty()) return;
  ++state_.step;
  replace_some(static_cast<std::size_t>(share * static_cast<double>(state_.particles.size())),
               ProposalDraw(proposals, region_));
}

template <typename DrawState>
void Filter::replace_some(std::size_t count, DrawState draw) {
  if (count == 0) return;
  Particles& p = state_.particles;
  std::vector<std::size_t> places(p.size());
  std::iota(places.begin(), places.end(), std::size_t{0});
  RandomStream choice(Draw::kChoice, {state_.seed, state_.step, 0});
  for (std::size_t k = 0; k < count; ++k) {
    std::swap(places[k], places[k + choice.next() % (places.size() - k)]);
    RandomStream random(Draw::kInject, {state_.seed, state_.step, k});
    p.set(places[k], draw(random));
    p.weight[places[k]] = 1.0 / static_cast<double>(p.size());
  }
  normalise(p.weight);
}

}  // namespace roadfix
