// Memory for which many ask: what would go beyond it is refused at once.
#pragma once

#include <cstddef>
#include <mutex>

namespace roadfix::http {

class ByteBudget {
 public:
  explicit ByteBudget(std::size_t bytes) : left_(bytes) {}

  /// What one of them has taken so far, given back at its end. The budget must outlive it.
  class Share {
   public:
    Share() = default;
    ~Share();
    Share(const Share&) = delete;
    Share& operator=(const Share&) = delete;

    /// Takes so many bytes more; false, and nothing is taken, where so many are not left. A share has one budget.
    bool take(ByteBudget& budget, std::size_t bytes);

   private:
    ByteBudget* budget_ = nullptr;
    std::size_t bytes_ = 0;
  };

 private:
  std::mutex mutex_;
  std::size_t left_;
};

}  // namespace roadfix::http
