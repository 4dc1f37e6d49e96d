// What the kernel adds up at one place: whole numbers, so that every instruction set gives the same.
#pragma once

#include <cstdint>

namespace roadfix {

/// Over the cells observed in both, which count 0..254.
struct IntegerSums {
  std::int64_t n = 0, m = 0, l = 0, mm = 0, ll = 0, ml = 0;
};

}  // namespace roadfix
