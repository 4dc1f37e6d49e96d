// How much memory a test has taken.
#pragma once

#include <sys/resource.h>

namespace roadfix::testing {

/// The most that this process has ever held, KiB. Sanitizers keep what was let go of and count their own notes in:
/// where a test compares large pieces, it is skipped with them (ROADFIX_SANITIZED).
inline long peak_memory_kib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

}  // namespace roadfix::testing
