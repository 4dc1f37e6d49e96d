// How many of the threads that serve connections are held: by requests that wait for their turn, are searched for, or
// stream. Each of these is few by itself; together they must leave some threads to what is answered at once.
#pragma once

#include <atomic>

namespace roadfix::http {

class HeldThreads {
 public:
  /// A quarter of the threads, 8 at most, are left to what is answered at once.
  explicit HeldThreads(int threads);

  /// The thread of one request, given back at the end of the share.
  class Share {
   public:
    Share() = default;
    ~Share() { give_back(); }
    Share(const Share&) = delete;
    Share& operator=(const Share&) = delete;

    /// Once. Throws Busy where no thread is left to hold, and nothing is taken.
    void take(HeldThreads& held);
    /// The same for one that may take half of the threads left to others, while one that waits makes room for it.
    void take_in_advance(HeldThreads& held);
    void give_back();

   private:
    void take(HeldThreads& held, int most);
    HeldThreads* held_ = nullptr;
  };

  /// Whether more are held than should be: who comes may only take the place of another.
  bool too_many() const { return held_ > most_; }

 private:
  const int most_;
  const int most_in_advance_;
  std::atomic<int> held_ = 0;
};

}  // namespace roadfix::http
