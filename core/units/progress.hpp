// How far a long work has come.
#pragma once

#include <cstdint>
#include <functional>

namespace roadfix {

/// Called with what is done, which grows, and what there is in all: from any thread, one call at a time. May be empty.
using OnProgress = std::function<void(std::int64_t done, std::int64_t total)>;

}  // namespace roadfix
