#include "core/units/memory.hpp"

#include <cstdlib>  // defines __GLIBC__ where it applies

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace roadfix {

void keep_freed_memory() {
#if defined(__GLIBC__)
  constexpr int kMiB = 1 << 20;
  mallopt(M_MMAP_THRESHOLD, 32 * kMiB);  // larger blocks are mapped one by one; glibc allows no more
  mallopt(M_TRIM_THRESHOLD, 64 * kMiB);
#endif
}

}  // namespace roadfix
