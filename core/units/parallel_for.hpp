// A loop over several threads.
#pragma once

#include <functional>

namespace roadfix {

/// Of this machine, at least 1.
int processors();

/// Calls work(i) for 0 <= i < count, in order of i, from up to `threads` threads, the caller's among them. The first
/// exception ends the loop and is thrown here.
void parallel_for(int count, int threads, const std::function<void(int)>& work);

}  // namespace roadfix
