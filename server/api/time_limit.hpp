// A stop token that is requested at a deadline, or when the client hangs up, for work that knows tokens and no clock.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>
#include <utility>

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

}  // namespace roadfix::api
