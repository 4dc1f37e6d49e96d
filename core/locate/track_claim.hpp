// Whether a track may claim the place that it believes in. Particles gather somewhere also where nothing speaks for it,
// and frames that follow each other show much the same ground, so that what agrees by chance goes on agreeing: a claim
// wants measurements that bear it out, and a search that has told it from other places.
#pragma once

#include <cstdint>
#include <optional>

namespace roadfix {

/// So long a place is claimed without an accepted measurement; then it is searched for.
inline constexpr double kStaleAfterS = 60.0;

/// Of the filter (Filter::doubt()): beyond it a place is not claimed, and is searched for.
inline constexpr double kMaxDoubt = 0.4;

/// What measurements and searches have said of a belief since it began.
struct TrackClaim {
  static constexpr std::int64_t kMaxSupport = 5;

  /// Balance of the last measurements: up by one when accepted, down when rejected, in [0, kMaxSupport]. Three
  /// rejections in a row take a claim back.
  std::int64_t supported = 0;
  /// Log of the odds of the belief against chance, a sum that begins anew at 0 (Page's test): it forgets what came
  /// before a kidnapping, and has an upper bound, so that a track that has long been right does not go on for long when
  /// it is not any more.
  double log_odds = 0.0;
  /// A search has told the belief from all other places, or where the whole map is too much to search, from those up to
  /// some kilometres around: a fix, or nearly one at the place that was believed before it. Until measurements speak
  /// against it.
  bool confirmed = false;
  /// Time of the last search around the place that bore it out; nullopt = none since a search found the place,
  /// something spoke against it or such a search did not bear it out, and nothing is claimed then.
  std::optional<std::int64_t> looked_time_us{};
  /// The way flown since that search, or where there was none, since the step before.
  double flown_m = 0.0;

  void accept();
  /// Something speaks against the place. A claim that is taken back waits for a search.
  void reject();
  /// `log_ratio`: how much likelier a measurement is under the belief than by chance.
  void weigh(double log_ratio);
  /// A search gave a fix of this probability, in [0, 1), there. It is yet to be looked around: the next frame tells
  /// whether the odometry carries the place on rightly.
  void confirm(double probability);

  /// A search found the place that was believed, and told it from all others, or could not.
  void tell_apart(bool from_all_others);
  /// The belief took other places in, or went over to one: it is to be told from them anew.
  void reopen();

  /// A search around the place found it there.
  void bear_out(std::int64_t time_us);
  /// It holds no longer that one did.
  void lose_look();
  void fly(double way_m);

  bool is_supported() const;
  /// A hundred to one against chance.
  bool outweighs_chance() const;
  bool is_told_apart() const;
  bool waits_for_search() const;

  friend bool operator==(const TrackClaim&, const TrackClaim&) = default;
};

}  // namespace roadfix
