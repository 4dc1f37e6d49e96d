#include "cli/fly/service_connection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <condition_variable>
#include <mutex>
#include <nlohmann/json.hpp>

#include "core/units/error.hpp"

namespace roadfix::fly {
namespace {

using http::Answer;
using nlohmann::json;

constexpr std::chrono::seconds kAnswerTime{600};  // a first search of a large map takes its time

/// Worth another try: the request came too slowly, the service has too much to do or cannot write just now, or a proxy
/// does not find it (docs/service.md).
constexpr std::array kMayPass{408, 429, 502, 503, 504};

bool may_pass(const std::optional<Answer>& answer) {
  return !answer || std::ranges::find(kMayPass, answer->status) != kMayPass.end();
}

/// Other services' answers may hold anything there.
std::string text_of(const json& problem, const char* member) {
  const auto found = problem.find(member);
  return found != problem.end() && found->is_string() ? found->get<std::string>() : "?";
}

std::string reason_of(const std::optional<Answer>& answer) {
  if (!answer) return "no answer";
  const json problem = json::parse(answer->body, nullptr, false);
  if (!problem.is_object()) return std::to_string(answer->status);
  return fmt::format("{} {}: {}", answer->status, text_of(problem, "code"), text_of(problem, "detail"));
}

json content_of(const Answer& answer) {
  if (answer.status >= 400) throw InvalidInput("service-refused", "the service refused: " + reason_of(answer));
  return answer.body.empty() ? json() : json::parse(answer.body, nullptr, false);
}

}  // namespace

ServiceConnection::ServiceConnection(const ServicePlan& plan)
    : client_(plan.base, kAnswerTime), base_(plan.base), patience_(plan.patience), stop_(plan.stop) {}

json ServiceConnection::ask(const Send& send) {
  const Clock::time_point began = Clock::now();
  json content = answered(send, began);
  waited_ += Clock::now() - began;
  return content;
}

json ServiceConnection::answered(const Send& send, Clock::time_point began) {
  constexpr std::chrono::milliseconds kFirstPause{20};
  constexpr std::chrono::milliseconds kLongestPause{2000};
  for (std::chrono::milliseconds pause = kFirstPause;; pause = std::min(2 * pause, kLongestPause)) {
    const std::optional<Answer> answer = send(client_);
    if (!may_pass(answer)) return content_of(*answer);
    if (stop_.stop_requested()) throw Interrupted("work-stopped", "the flights were stopped");
    if (Clock::now() + pause > began + patience_) {
      throw IoFailure(
          "service-silent",
          fmt::format(
              "the service at {} did not take a request within {} s ({}): is roadfix serve running there? If it is "
              "busy, raise --patience",
              base_, patience_.count(), reason_of(answer)));
    }
    rest(answer && answer->retry_after ? std::max<std::chrono::milliseconds>(pause, *answer->retry_after) : pause);
  }
}

void ServiceConnection::rest(std::chrono::milliseconds pause) const {
  std::mutex mutex;
  std::unique_lock lock(mutex);
  std::condition_variable_any stopped;
  stopped.wait_for(lock, stop_, pause, [] { return false; });
}

}  // namespace roadfix::fly
