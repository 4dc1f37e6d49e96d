// The threads that searches share: one that runs alone has them all, several have about equal parts.
#pragma once

#include <algorithm>
#include <atomic>

namespace roadfix::server {

class SearchThreads {
 public:
  /// At least 1.
  explicit SearchThreads(int count) : count_(count) {}

  /// Of one search, for as long as it runs. It keeps what it was given when others come or end.
  class Share {
   public:
    explicit Share(SearchThreads& all) : all_(all), threads_(std::max(1, all.count_ / ++all.searches_)) {}
    ~Share() { --all_.searches_; }
    Share(const Share&) = delete;
    Share& operator=(const Share&) = delete;

    int threads() const { return threads_; }

   private:
    SearchThreads& all_;
    int threads_;
  };

 private:
  const int count_;
  std::atomic<int> searches_{0};
};

}  // namespace roadfix::server
