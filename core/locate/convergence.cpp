#include "core/locate/convergence.hpp"

namespace roadfix {
namespace {

constexpr double kConvergedWeight = 0.9;
constexpr double kConvergedSigmaM = 25.0;

/// Equation (7) is no ratio to chance: what it does not reject counts as told from others.
bool is_told_from_others(const TrackSettings& settings, const TrackerState& state) {
  if (settings.measurement_model.kind == LikelihoodKind::kEquation7) return true;
  if (!settings.recovers) return state.claim.outweighs_chance();
  return state.claim.is_told_apart() && state.claim.looked_time_us;
}

}  // namespace

bool has_converged(const TrackSettings& settings, const TrackerState& state, const Cluster& best,
                   Measurement measurement, double doubt) {
  return best.weight >= kConvergedWeight && best.sigma_m() <= kConvergedSigmaM &&
         measurement != Measurement::kRejected && measurement != Measurement::kRepeated &&
         !state.last_view.stands_still && state.claim.is_supported() && is_told_from_others(settings, state) &&
         doubt <= kMaxDoubt && state.since_accepted_s(state.last->time_us).value_or(kStaleAfterS) < kStaleAfterS;
}

}  // namespace roadfix
