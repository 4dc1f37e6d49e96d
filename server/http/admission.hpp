// Heavy requests wait their turn: a few run, a few wait in the order they came, the others are told to come back.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <list>
#include <mutex>

namespace roadfix::http {

class Admission {
 public:
  Admission(int running, int waiting) : max_running_(running), max_waiting_(waiting) {}

  class Ticket {
   public:
    explicit Ticket(Admission& admission) : admission_(&admission) {}
    ~Ticket() { admission_->leave(); }
    Ticket(const Ticket&) = delete;
    Ticket& operator=(const Ticket&) = delete;

   private:
    Admission* admission_;
  };

  /// First come, first served. Throws Busy when too many wait already or the deadline comes first, ClientGone when it
  /// was abandoned, which is asked now and then.
  Ticket enter(std::chrono::steady_clock::time_point deadline, const std::function<bool()>& abandoned = {});

  int running() const;
  int waiting() const;

 private:
  void leave();

  mutable std::mutex mutex_;
  std::condition_variable turn_;
  std::list<int> queue_;  ///< one element per waiting request, front first
  const int max_running_;
  const int max_waiting_;
  int running_ = 0;
};

}  // namespace roadfix::http
