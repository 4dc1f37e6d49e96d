#include "server/http/byte_budget.hpp"

#include <cassert>

namespace roadfix::http {

ByteBudget::Share::~Share() {
  if (budget_ == nullptr) return;
  const std::lock_guard lock(budget_->mutex_);
  budget_->left_ += bytes_;
}

bool ByteBudget::Share::take(ByteBudget& budget, std::size_t bytes) {
  assert(budget_ == nullptr || budget_ == &budget);
  const std::lock_guard lock(budget.mutex_);
  if (bytes > budget.left_) return false;
  budget.left_ -= bytes;
  budget_ = &budget;
  bytes_ += bytes;
  return true;
}

}  // namespace roadfix::http
