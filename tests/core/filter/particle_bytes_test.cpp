#include "core/filter/particle_bytes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <vector>

#include "core/units/error.hpp"
#include "tests/core/filter/square.hpp"

namespace roadfix {
namespace {

using testing::kSquare;
using testing::seen_at;

TEST(FilterState, ComesBackFromItsBytesAndGoesOnTheSame) {
  Filter filter({}, {kSquare, 0.0, 0.2}, 5);
  filter.start_uniformly(kSquare);
  const auto step = [](Filter& f) {
    f.predict(PlanarMotion{{20.0, 2.0}, {0.0, 0.05}, 1.0, 0.1});
    f.correct(seen_at(f.particles(), {500.0, 300.0}, 30.0));
  };
  step(filter);
  Filter copy({}, {kSquare, 0.0, 0.2}, filter_state_of(to_bytes(filter.state())));
  EXPECT_EQ(copy.state(), filter.state());
  step(filter);
  step(copy);
  EXPECT_EQ(copy.state(), filter.state());
}

TEST(FilterState, RefusesBytesThatAreCutOrDamaged) {
  Filter filter({}, {kSquare}, 5);
  filter.start_uniformly(kSquare);
  const std::vector<std::byte> whole = to_bytes(filter.state());
  for (const std::size_t size : {std::size_t{0}, std::size_t{7}, std::size_t{60}, whole.size() - 1}) {
    EXPECT_THROW(filter_state_of(std::span(whole).first(size)), CorruptData) << size;
  }
  for (const std::size_t at : {std::size_t{0}, std::size_t{8}, std::size_t{47}, whole.size() - 1}) {
    std::vector<std::byte> damaged = whole;
    damaged[at] = std::byte{0x7f};
    damaged[at - at % 8 + 6] = std::byte{0xf8};
    EXPECT_THROW(filter_state_of(damaged), CorruptData) << at;
  }
  FilterState nowhere = filter.state();
  std::ranges::fill(nowhere.particles.weight, 0.0);
  EXPECT_THROW(filter_state_of(to_bytes(nowhere)), CorruptData);
  FilterState unsupported = filter.state();
  unsupported.slow_support = 0.0;
  EXPECT_THROW(filter_state_of(to_bytes(unsupported)), CorruptData) << "its doubt would be 0 / 0";
}

}  // namespace
}  // namespace roadfix
