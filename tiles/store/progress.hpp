// How far a long work on a map has come.
#pragma once

#include <cstdint>
#include <functional>

namespace roadfix {

/// Called with what is done and what there is in all, in tiles or blocks unless it says otherwise; may be empty.
using OnProgress = std::function<void(std::int64_t done, std::int64_t total)>;

}  // namespace roadfix
