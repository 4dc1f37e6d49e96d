#include "core/units/memory.hpp"

#include <cstdlib>  // defines __GLIBC__ where it applies

#if defined(__GLIBC__)
#include <malloc.h>

#include <algorithm>
#include <thread>
#endif

namespace roadfix {

void keep_freed_memory() {
#if defined(__GLIBC__)
  constexpr int kMiB = 1 << 20;
  mallopt(M_MMAP_THRESHOLD, 32 * kMiB);  // larger blocks are mapped one by one; glibc allows no more
  mallopt(M_TRIM_THRESHOLD, 64 * kMiB);
  // Each of them holds what its threads have freed: glibc would make eight for each processor.
  mallopt(M_ARENA_MAX, static_cast<int>(std::max(2U, std::thread::hardware_concurrency())));
#endif
}

void give_back_freed_memory() {
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
}

}  // namespace roadfix
