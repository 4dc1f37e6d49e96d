#include "server/http/admission.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "server/http/errors.hpp"

namespace roadfix::http {
namespace {

constexpr std::chrono::seconds kRetryAfter{1};
constexpr std::chrono::milliseconds kLookPause{100};

}  // namespace

Admission::Ticket Admission::enter(std::chrono::steady_clock::time_point deadline,
                                   const std::function<bool()>& abandoned) {
  using Clock = std::chrono::steady_clock;
  std::unique_lock lock(mutex_);
  if (running_ < max_running_ && queue_.empty()) {
    ++running_;
    return Ticket(*this);
  }
  if (static_cast<int>(queue_.size()) >= max_waiting_) {
    throw Busy(fmt::format("{} requests run and {} wait already; try again", running_, queue_.size()), kRetryAfter);
  }
  const auto place = queue_.insert(queue_.end(), 0);
  const auto is_mine = [&] { return place == queue_.begin() && running_ < max_running_; };
  bool mine = false;
  bool gone = false;
  do {
    mine = turn_.wait_until(lock, std::min(deadline, Clock::now() + kLookPause), is_mine);
    gone = abandoned && abandoned();
  } while (!mine && !gone && Clock::now() < deadline);
  queue_.erase(place);
  turn_.notify_all();
  if (gone) throw ClientGone();
  if (!mine) throw Busy("its turn did not come in the time that a request may wait; try again", kRetryAfter);
  ++running_;
  return Ticket(*this);
}

void Admission::leave() {
  const std::lock_guard lock(mutex_);
  --running_;
  turn_.notify_all();
}

int Admission::running() const {
  const std::lock_guard lock(mutex_);
  return running_;
}

int Admission::waiting() const {
  const std::lock_guard lock(mutex_);
  return static_cast<int>(queue_.size());
}

}  // namespace roadfix::http
