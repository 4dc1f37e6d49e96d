// Heavy requests wait their turn: a few run, a few wait, the others are told to come back.
//
// Clients take turns: the fewer requests of its client ran or waited when one came, the sooner it is next; among equals
// the one that came first. So no client that sends many at once keeps another waiting for all of them.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace roadfix::http {

class Admission {
 public:
  Admission(int running, int waiting) : max_running_(running), max_waiting_(waiting) {}

  class Ticket {
   public:
    Ticket(Admission& admission, std::string client) noexcept : admission_(&admission), client_(std::move(client)) {}
    ~Ticket() { admission_->leave(client_); }
    Ticket(const Ticket&) = delete;
    Ticket& operator=(const Ticket&) = delete;

   private:
    Admission* admission_;
    std::string client_;
  };

  /// Throws Busy when too many wait already or the deadline comes first, ClientGone when it was abandoned, which is
  /// asked now and then. Where too many wait, or where it may only `replace` another that waits, the last in turn makes
  /// room for one that comes before it, and gets the Busy.
  Ticket enter(const std::string& client, std::chrono::steady_clock::time_point deadline,
               const std::function<bool()>& abandoned = {}, bool replace = false);

  int running() const;
  int waiting() const;

 private:
  struct Waiting {
    int rank = 0;  ///< how many of its client ran or waited when it came
  };

  void make_room_for(const Waiting& newcomer);
  bool waits(const Waiting& request) const;
  void leave(const std::string& client);
  void forget(const std::string& client);

  mutable std::mutex mutex_;
  std::condition_variable turn_;
  std::vector<const Waiting*> queue_;     ///< in the order of their turns
  std::map<std::string, int> of_client_;  ///< how many run or wait, of clients that have any
  int running_ = 0;
  const int max_running_;
  const int max_waiting_;
};

}  // namespace roadfix::http
