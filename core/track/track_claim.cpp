#include "core/track/track_claim.hpp"

#include <algorithm>
#include <cmath>

namespace roadfix {
namespace {

constexpr std::int64_t kMinSupport = 3;
static_assert(TrackClaim::kMaxSupport - kMinSupport + 1 == 3, "so many rejections take a claim back");
const double kMinLogOdds = std::log(100.0);
const double kMaxLogOdds = 2.0 * kMinLogOdds;

}  // namespace

void TrackClaim::accept() { supported = std::min(supported + 1, kMaxSupport); }

void TrackClaim::reject() {
  supported = std::max<std::int64_t>(0, supported - 1);
  if (!is_supported()) confirmed = false;
  forget_look();
}

void TrackClaim::weigh(double log_ratio) {
  log_odds = std::clamp(log_odds + log_ratio, 0.0, kMaxLogOdds);
  if (log_odds == 0.0) confirmed = false;
}

void TrackClaim::confirm(double probability) {
  accept();
  weigh(std::log(probability / (1.0 - probability)));
  confirmed = true;
  forget_look();
}

void TrackClaim::set_confirmed(bool others_ruled_out) { confirmed = others_ruled_out; }

void TrackClaim::reopen() {
  confirmed = false;
  forget_look();
}

void TrackClaim::bear_out(std::int64_t time_us) {
  looked_time_us = time_us;
  flown_m = 0.0;
}

void TrackClaim::forget_look() { looked_time_us.reset(); }

void TrackClaim::fly(double travelled_m) {
  if (!looked_time_us) flown_m = 0.0;
  flown_m += travelled_m;
}

bool TrackClaim::is_supported() const { return supported >= kMinSupport; }

bool TrackClaim::outweighs_chance() const { return log_odds >= kMinLogOdds; }

bool TrackClaim::is_told_apart() const { return outweighs_chance() && confirmed; }

bool TrackClaim::waits_for_search() const { return outweighs_chance() && !confirmed; }

}  // namespace roadfix
