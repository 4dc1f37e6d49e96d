#include "server/tracks/track_steps.hpp"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "core/units/error.hpp"
#include "core/units/json_text.hpp"
#include "server/api/json_body.hpp"
#include "server/api/json_parts.hpp"
#include "server/api/track_json.hpp"
#include "server/http/errors.hpp"
#include "server/http/metrics.hpp"

namespace roadfix::server {

std::optional<StepAnswer> TrackSteps::stored(const std::string& id, const SentStep& step) const {
  auto taken = tracks_.step(id, step.input.sequence);
  if (!taken) return std::nullopt;
  if (taken->digest != step.digest) {
    throw InvalidInput(
        "step-differs",
        fmt::format("step {} was already processed with different content: continue with the next number",
                    step.input.sequence));
  }
  return StepAnswer{api::stored_json(taken->answer), std::move(taken->answer), true};
}

std::optional<StepAnswer> TrackSteps::answered(const std::string& id, const SentStep& step) const {
  const std::shared_ptr<LiveTrack> track = tracks_.in_memory(id);
  // Before the store: a step that is taken meanwhile is not late, but answered.
  const auto before = track ? track->last_state() : nullptr;
  auto answer = stored(id, step);
  if (!answer && before) Tracker::require_possible(*before, step.input);
  return answer;
}

void TrackSteps::await_predecessor(const std::string& id, std::int64_t sequence) {
  const std::shared_ptr<LiveTrack> track = tracks_.in_memory(id);
  if (!track) return;
  // Each holds a connection's thread, and a step before it may take as long as a search.
  const int most = tracks_.limits().steps_waiting;
  const http::Counted waits(waiting_);
  if (waiting_ > most) {
    throw http::Busy(fmt::format("{} steps of tracks wait for those before them already; try again", most),
                     std::chrono::seconds(1));
  }
  track->await_predecessor(sequence, tracks_.limits().order_wait);
}

StepAnswer TrackSteps::take(const std::string& id, const SentStep& step, const StepLimits& limits) {
  const std::int64_t sequence = step.input.sequence;
  const std::shared_ptr<LiveTrack> track = tracks_.live(id);
  LiveTrack::Turn turn(*track, sequence, tracks_.limits().order_wait);
  if (auto before = stored(id, step)) return *std::move(before);
  if (turn.is_doubtful()) turn.settle(tracks_.stored_state(id));
  StepResult result = track->tracker().advance(turn.state(), step.input, limits);
  nlohmann::json answer = api::to_json(result.estimate);
  answer["track"] = id;
  answer["map"] = api::to_json(track->map().view.id);
  answer["made_by"] = api::made_by(step.detector);
  std::string text = json_text(answer);
  turn.doubt();
  tracks_.store_step(id, {sequence, step.digest, text}, result.state);
  turn.settle(std::move(result.state));
  tracks_.announce_step(id, sequence, step.came);
  return {std::move(answer), std::move(text)};
}

}  // namespace roadfix::server
