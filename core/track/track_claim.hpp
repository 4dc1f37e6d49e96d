// Whether a track may claim the place that it believes in. Particles always gather somewhere, and consecutive frames
// show much the same ground, so that what agrees by chance goes on agreeing: a claim needs measurements that support
// it, and a search that ruled out other places.
#pragma once

#include <cstdint>
#include <optional>

namespace roadfix {

/// A place is claimed for so long without an accepted measurement; then it is searched for.
inline constexpr double kStaleAfterS = 60.0;

/// With more doubt (Filter::doubt()) a place is not claimed, and is searched for.
inline constexpr double kMaxDoubt = 0.4;

/// What measurements and searches have said of a belief since it began.
struct TrackClaim {
  static constexpr std::int64_t kMaxSupport = 5;

  /// Balance of the last measurements: up by one when accepted, down by one when rejected, in [0, kMaxSupport]. Three
  /// rejections in a row withdraw a claim.
  std::int64_t supported = 0;
  /// Log odds of the belief against chance: a sum that is never below 0 (Page's test), so that it forgets what came
  /// before a kidnapping, and bounded above, so that a track that was right for long notices soon when it no longer is.
  double log_odds = 0.0;
  /// A search gave a fix, or nearly one at the place that was believed already, and so ruled out all other places; only
  /// those within some kilometres where the whole map is too large to search. Holds until measurements contradict it.
  bool confirmed = false;
  /// Time of the last look that bore the place out. nullopt, and nothing is claimed, where there was none since a
  /// search found the place, something contradicted it, or a look failed to bear it out.
  std::optional<std::int64_t> looked_time_us{};
  /// Distance flown since that look; if there is none, since the last step.
  double flown_m = 0.0;

  void accept();
  /// Something contradicts the place. A claim withdrawn for lack of support has to be confirmed again.
  void reject();
  /// `log_ratio`: how much likelier a measurement is under the belief than by chance.
  void weigh(double log_ratio);
  /// A search gave a fix of this probability, in [0, 1), there. A look is still needed: the next frame shows whether
  /// the odometry carries the place on correctly.
  void confirm(double probability);

  /// A search found the place that was believed, and ruled out all others or could not.
  void set_confirmed(bool others_ruled_out);
  /// The belief now includes other places, or moved to one: they have to be ruled out again.
  void reopen();

  /// A look found the vehicle at the place.
  void bear_out(std::int64_t time_us);
  /// The last look no longer counts.
  void forget_look();
  void fly(double travelled_m);

  bool is_supported() const;
  /// A hundred to one against chance.
  bool outweighs_chance() const;
  bool is_told_apart() const;
  bool waits_for_search() const;

  friend bool operator==(const TrackClaim&, const TrackClaim&) = default;
};

}  // namespace roadfix
