#include "server/http/held_threads.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <chrono>
#include <utility>

#include "server/http/errors.hpp"

namespace roadfix::http {
namespace {

constexpr int kMostLeft = 8;

int left_to_others(int threads) { return std::min(kMostLeft, threads / 4); }

}  // namespace

HeldThreads::HeldThreads(int threads)
    : most_(threads - left_to_others(threads)), most_in_advance_(threads - left_to_others(threads) / 2) {}

void HeldThreads::Share::take(HeldThreads& held) { take(held, held.most_); }

void HeldThreads::Share::take_in_advance(HeldThreads& held) { take(held, held.most_in_advance_); }

void HeldThreads::Share::take(HeldThreads& held, int most) {
  assert(held_ == nullptr);
  if (++held.held_ > most) {
    --held.held_;
    throw Busy(fmt::format("{} requests wait, run or stream already, and the other threads (serve --threads) are for "
                           "what is answered at once; try again",
                           most),
               kRetrySoon);
  }
  held_ = &held;
}

void HeldThreads::Share::give_back() {
  if (HeldThreads* held = std::exchange(held_, nullptr)) --held->held_;
}

}  // namespace roadfix::http
