#include "core/units/memory.hpp"

#include <cstdlib>  // defines __GLIBC__ where it applies

#if defined(__GLIBC__)
#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "core/units/parallel_for.hpp"
#endif

namespace roadfix {

#if defined(__GLIBC__)
namespace {

/// In memory, not only in the address space: malloc's own figures count what was given back as freed, too.
std::size_t freed_bytes() {
  std::size_t all = 0;
  std::size_t resident = 0;  // pages
  std::size_t shared = 0;
  std::ifstream("/proc/self/statm") >> all >> resident >> shared;
  const std::size_t own = (resident - shared) * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  const struct mallinfo2 now = mallinfo2();
  return own - std::min(own, now.uordblks + now.hblkhd);
}

}  // namespace
#endif

void keep_freed_memory() {
#if defined(__GLIBC__)
  constexpr int kMiB = 1 << 20;
  mallopt(M_MMAP_THRESHOLD, 32 * kMiB);  // larger blocks are mapped one by one; glibc allows no more
  mallopt(M_TRIM_THRESHOLD, 64 * kMiB);
  // Each of them holds what its threads have freed: glibc would make eight for each processor.
  mallopt(M_ARENA_MAX, std::max(2, processors()));
#endif
}

void give_back_freed_memory() {
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
}

void give_back_freed_memory_beyond([[maybe_unused]] std::size_t bytes) {
#if defined(__GLIBC__)
  if (freed_bytes() > bytes) give_back_freed_memory();
#endif
}

}  // namespace roadfix
