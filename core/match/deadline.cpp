#include "core/match/deadline.hpp"

#include <algorithm>

#include "core/units/error.hpp"

namespace roadfix {

void require_not_stopped(const std::stop_token& stop) {
  if (stop.stop_requested()) throw Interrupted("search-stopped", "the search was asked to stop before it was done");
}

bool Deadline::over() const {
  require_not_stopped(stop_);
  return time_is_over();
}

Deadline Deadline::after(double share) const {
  if (!end_) return *this;
  const auto now = std::chrono::steady_clock::now();
  const std::chrono::duration<double> left = *end_ - now;
  return Deadline(stop_, now + std::chrono::duration_cast<std::chrono::steady_clock::duration>(share * left));
}

Deadline Deadline::within(std::optional<std::chrono::milliseconds> time) const {
  if (!time) return *this;
  const auto end = std::chrono::steady_clock::now() + *time;
  return Deadline(stop_, std::min(end, end_.value_or(end)));
}

}  // namespace roadfix
