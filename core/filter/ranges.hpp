// Splits work over equal ranges of particles, one for each thread.
#pragma once

#include <cstddef>
#include <functional>

namespace roadfix {

/// Calls work(first, last) for ranges that cover 0..count once. The first exception of the work is thrown here.
void for_ranges(std::size_t count, int threads, const std::function<void(std::size_t, std::size_t)>& work);

}  // namespace roadfix
