#include "server/api/time_limit.hpp"

namespace roadfix::api {

TimeLimit::TimeLimit(http::Clock::time_point deadline)
    : timer_([this, deadline](std::stop_token ended) {
        std::unique_lock lock(mutex_);
        wake_.wait_until(lock, ended, deadline, [&] { return ended.stop_requested(); });
        if (!ended.stop_requested()) source_.request_stop();
      }) {}

}  // namespace roadfix::api
