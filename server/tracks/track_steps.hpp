// Takes the steps of tracks: each once, those of one track in order and one at a time. Those of different tracks run
// side by side.
#pragma once

#include <atomic>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "server/tracks/track_registry.hpp"

namespace roadfix::server {

/// What a step was answered.
struct StepAnswer {
  nlohmann::json answer;
  std::string text;       ///< the same, byte by byte as it was told before and is stored
  bool repeated = false;  ///< the step had been taken before
};

/// A step as it came.
struct SentStep {
  StepInput input;
  std::int64_t digest = 0;  ///< of all that it says, to tell a repeated step from another of that number
  TrackTimes::Clock::time_point came;
  std::optional<std::string> detector{};  ///< what read its frame, if there was one
};

class TrackSteps {
 public:
  explicit TrackSteps(TrackRegistry& tracks) : tracks_(tracks) {}

  /// What a step was answered, if it was taken already. Throws InvalidInput: "step-differs" where that was another step
  /// of the same number; of a track in memory what Tracker::require_possible does, before roads are looked for in the
  /// step's frame.
  std::optional<StepAnswer> answered(const std::string& id, const SentStep& step) const;
  /// Gives the steps that this one overtook the time that they may have to be taken first. They may need a turn among
  /// the searches for that, so that it holds none meanwhile. Throws Busy where too many wait.
  void await_predecessor(const std::string& id, std::int64_t sequence);
  /// Takes the step, unless that was done meanwhile, and returns its answer once it cannot be lost any more. Throws
  /// what Tracker::advance throws, InvalidInput ("map-replaced") and the store's errors; the track is then as it was.
  StepAnswer take(const std::string& id, const SentStep& step, const StepLimits& limits);

 private:
  std::optional<StepAnswer> stored(const std::string& id, const SentStep& step) const;

  TrackRegistry& tracks_;
  std::atomic<int> waiting_ = 0;  ///< steps of all tracks, for those before them
};

}  // namespace roadfix::server
