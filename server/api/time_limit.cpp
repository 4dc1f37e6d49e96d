#include "server/api/time_limit.hpp"

#include <algorithm>
#include <utility>

#include "core/units/error.hpp"

namespace roadfix::api {
namespace {

constexpr std::chrono::milliseconds kLookPause{100};

}  // namespace

TimeLimit::TimeLimit(http::Clock::time_point deadline, std::function<bool()> abandoned)
    : timer_([this, deadline, abandoned = std::move(abandoned)](std::stop_token ended) {
        std::unique_lock lock(mutex_);
        while (!ended.stop_requested()) {
          const auto now = http::Clock::now();
          if (now >= deadline || (abandoned && abandoned())) {
            source_.request_stop();
            return;
          }
          const auto look = abandoned ? std::min(deadline, now + kLookPause) : deadline;
          wake_.wait_until(lock, ended, look, [&] { return ended.stop_requested(); });
        }
      }) {}

Deadline search_end(http::Clock::time_point deadline, std::stop_token stop, double share) {
  const Deadline end(std::move(stop), deadline);
  if (http::Clock::now() >= deadline) {
    throw Interrupted("request-deadline", "the time limit ended before the answer was ready; try again");
  }
  return end.after(share);
}

}  // namespace roadfix::api
