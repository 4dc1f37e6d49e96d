// What the C library does with memory that the program frees.
#pragma once

namespace roadfix {

/// For programs that take and free megabytes again and again, as a service does with each request: freed memory is kept
/// for the next request, up to some 64 MiB for each thread that took it, where glibc would return it to the kernel and
/// pay for every page anew. Call it first in main(). Does nothing with another C library.
void keep_freed_memory();

}  // namespace roadfix
