#include "server/http/admission.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "server/http/errors.hpp"

namespace roadfix::http {
namespace {

constexpr std::chrono::milliseconds kLookPause{100};

}  // namespace

Admission::Ticket Admission::enter(const std::string& client, std::chrono::steady_clock::time_point deadline,
                                   const std::function<bool()>& abandoned, bool replace) {
  using Clock = std::chrono::steady_clock;
  std::string name = client;  // before anything is counted: memory may run out
  std::unique_lock lock(mutex_);
  const bool at_once = running_ < max_running_ && queue_.empty();
  const auto known = of_client_.find(name);
  const Waiting mine{known == of_client_.end() ? 0 : known->second};
  if (!at_once && (replace || std::ssize(queue_) >= max_waiting_)) make_room_for(mine);
  queue_.reserve(queue_.size() + 1);
  ++of_client_[name];
  queue_.insert(std::ranges::upper_bound(queue_, mine.rank, {}, &Waiting::rank), &mine);
  const auto is_over = [&] { return !waits(mine) || (running_ < max_running_ && queue_.front() == &mine); };
  bool over = at_once;
  bool gone = false;
  while (!over && !gone && Clock::now() < deadline) {
    over = turn_.wait_until(lock, std::min(deadline, Clock::now() + kLookPause), is_over);
    gone = abandoned && abandoned();
  }
  const bool sent_away = std::erase(queue_, &mine) == 0;
  turn_.notify_all();
  if (over && !sent_away && !gone) {
    ++running_;
    return {*this, std::move(name)};
  }
  forget(name);
  if (gone) throw ClientGone();
  if (sent_away) throw Busy("others wait, with fewer requests than this client; try again", kRetrySoon);
  throw Busy("its turn did not come in the time that a request may wait; try again", kRetrySoon);
}

void Admission::make_room_for(const Waiting& newcomer) {
  if (queue_.empty() || queue_.back()->rank <= newcomer.rank) {
    throw Busy(fmt::format("{} requests run and {} wait already; try again", running_, queue_.size()), kRetrySoon);
  }
  queue_.pop_back();
  turn_.notify_all();
}

bool Admission::waits(const Waiting& request) const { return std::ranges::find(queue_, &request) != queue_.end(); }

void Admission::leave(const std::string& client) {
  const std::lock_guard lock(mutex_);
  --running_;
  forget(client);
  turn_.notify_all();
}

void Admission::forget(const std::string& client) {
  if (--of_client_[client] == 0) of_client_.erase(client);
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
