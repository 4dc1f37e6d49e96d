#include "core/track/convergence.hpp"

namespace roadfix {
namespace {

constexpr double kConvergedWeight = 0.9;
constexpr double kConvergedSigmaM = 25.0;

/// Equation (7) is no ratio to chance: what it does not reject counts as told from others.
std::optional<Unclaimed> why_not_told_from_others(const TrackSettings& settings, const TrackClaim& claim) {
  if (settings.measurement_model.kind == LikelihoodKind::kEquation7) return std::nullopt;
  if (!claim.outweighs_chance()) return Unclaimed::kMayBeChance;
  if (!settings.recovers) return std::nullopt;
  if (!claim.is_told_apart()) return Unclaimed::kOthersNotRuledOut;
  if (!claim.looked_time_us) return Unclaimed::kNotBorneOut;
  return std::nullopt;
}

}  // namespace

std::optional<Unclaimed> why_unclaimed(const TrackSettings& settings, const TrackerState& state, const Cluster& best,
                                       Measurement measurement, double doubt) {
  const double since_accepted_s = state.since_accepted_s(state.last->time_us).value_or(kStaleAfterS);
  if (measurement == Measurement::kRepeated || state.last_view.stands_still) return Unclaimed::kFrameRepeated;
  if (measurement == Measurement::kRejected) return Unclaimed::kFrameRejected;
  if (!(best.weight >= kConvergedWeight)) return Unclaimed::kSeveralPlaces;
  if (!(best.sigma_m() <= kConvergedSigmaM)) return Unclaimed::kPlaceTooWide;
  if (!state.claim.is_supported()) return Unclaimed::kTooFewAgree;
  if (!(since_accepted_s < kStaleAfterS)) return Unclaimed::kNoneAgreedLately;
  if (!(doubt <= kMaxDoubt)) return Unclaimed::kFramesAgreeLess;
  return why_not_told_from_others(settings, state.claim);
}

}  // namespace roadfix
