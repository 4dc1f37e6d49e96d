// A stop token that is requested at a deadline, for work that knows tokens and no clock.
#pragma once

#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <thread>

#include "server/http/message.hpp"

namespace roadfix::api {

class TimeLimit {
 public:
  explicit TimeLimit(http::Clock::time_point deadline);
  std::stop_token token() const { return source_.get_token(); }

 private:
  std::stop_source source_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::jthread timer_;  ///< last: ends before what it uses
};

}  // namespace roadfix::api
