// What ends work in time for the answer: a stop token that is requested at a deadline, or when the client hangs up, for
// work that knows tokens and no clock; a deadline for searches.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>
#include <utility>

#include "core/match/deadline.hpp"
#include "server/http/message.hpp"

namespace roadfix::api {

class TimeLimit {
 public:
  /// `abandoned` is asked ten times a second.
  explicit TimeLimit(http::Clock::time_point deadline, std::function<bool()> abandoned = {});
  std::stop_token token() const { return source_.get_token(); }

 private:
  std::stop_source source_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::jthread timer_;  ///< last: ends before what it uses
};

/// The same without a deadline, for work that looks at the clock itself.
class HangUp {
 public:
  explicit HangUp(std::function<bool()> abandoned) : watch_(http::Clock::time_point::max(), std::move(abandoned)) {}
  std::stop_token token() const { return watch_.token(); }

 private:
  TimeLimit watch_;
};

/// After this share of the time that is left: early enough to answer with what was found. Throws Interrupted
/// ("request-deadline") when none is left.
Deadline search_end(http::Clock::time_point deadline, std::stop_token stop, double share = 0.95);

}  // namespace roadfix::api
