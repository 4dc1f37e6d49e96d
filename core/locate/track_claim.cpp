#include "core/locate/track_claim.hpp"

#include <algorithm>
#include <cmath>

namespace roadfix {
namespace {

constexpr std::int64_t kLeastSupport = 3;
constexpr std::int64_t kMostSupport = 5;
const double kLeastLogOdds = std::log(100.0);
const double kMostLogOdds = 2.0 * kLeastLogOdds;

}  // namespace

void TrackClaim::accept() { supported = std::min(supported + 1, kMostSupport); }

void TrackClaim::reject() {
  supported = std::max<std::int64_t>(0, std::min(supported, kMostSupport) - 1);
  if (!is_supported()) compared = false;
}

void TrackClaim::weigh(double log_ratio) {
  log_odds = std::clamp(log_odds + log_ratio, 0.0, kMostLogOdds);
  if (log_odds == 0.0) compared = false;
}

void TrackClaim::confirm(double probability) {
  accept();
  weigh(std::log(probability / (1.0 - probability)));
  compared = true;
}

bool TrackClaim::is_supported() const { return supported >= kLeastSupport; }

bool TrackClaim::outweighs_chance() const { return log_odds >= kLeastLogOdds; }

}  // namespace roadfix
