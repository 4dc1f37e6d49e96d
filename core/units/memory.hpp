// What the C library does with memory that the program frees.
#pragma once

#include <cstddef>

namespace roadfix {

/// For programs that take and free megabytes again and again, as a service does with each request: freed memory is kept
/// for the next request, for each processor up to some 64 MiB beyond what is in use and all that lies between, where
/// glibc would return it to the kernel and pay for every page anew. Call it first in main(). Does nothing with another
/// C library.
void keep_freed_memory();

/// After work that took hundreds of megabytes: all that is freed goes back to the kernel, also between blocks that are
/// kept, which would hold it for ever. Takes some milliseconds. Does nothing with another C library.
void give_back_freed_memory();

/// The same where more than so many bytes of freed memory are kept, for programs that run for weeks: blocks of ever
/// other sizes leave gaps between each other, which add up to several times what is in use at once. To be called now
/// and then.
void give_back_freed_memory_beyond(std::size_t bytes);

}  // namespace roadfix
