#include "core/filter/particle_bytes.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <numeric>
#include <string>

#include "core/units/error.hpp"
#include "core/units/words.hpp"

namespace roadfix {
namespace {

constexpr std::uint64_t kMagic = 0x3230'5346'4652ULL;  // "RFFS02"
constexpr std::size_t kMaxParticles = 10'000'000;
constexpr std::size_t kColumns = 7;
constexpr std::size_t kHeaderWords = 7;

auto columns_of(auto& p) {
  return std::array{&p.east_m,          &p.north_m, &p.heading_rad, &p.drift_east_m_s,
                    &p.drift_north_m_s, &p.weight,  &p.log_scale};
}

[[noreturn]] void refuse(const char* what) {
  throw CorruptData("filter-state-corrupt",
                    std::string("the stored state of a filter ") + what + ": delete the track and begin a new one");
}

}  // namespace

std::vector<std::byte> to_bytes(const FilterState& state) {
  std::vector<std::byte> bytes;
  const std::size_t count = state.particles.size();
  bytes.reserve(kWordBytes * (kHeaderWords + kColumns * count));
  for (const std::uint64_t word :
       {kMagic, std::uint64_t{count}, state.seed, state.step, state.resets,
        std::bit_cast<std::uint64_t>(state.slow_support), std::bit_cast<std::uint64_t>(state.fast_support)}) {
    put_word(bytes, word);
  }
  for (const auto* column : columns_of(state.particles)) {
    const auto data = std::as_bytes(std::span(*column));
    bytes.insert(bytes.end(), data.begin(), data.end());
  }
  return bytes;
}

FilterState filter_state_of(std::span<const std::byte> bytes) {
  const std::uint64_t magic = bytes.size() < kWordBytes * kHeaderWords ? 0 : word_at(bytes, 0);
  if (magic != kMagic) refuse("is of no known version");
  const std::uint64_t count = word_at(bytes, 1);
  if (count == 0 || count > kMaxParticles || bytes.size() != kWordBytes * (kHeaderWords + kColumns * count)) {
    refuse("is not whole");
  }
  FilterState state;
  state.seed = word_at(bytes, 2);
  state.step = word_at(bytes, 3);
  state.resets = word_at(bytes, 4);
  state.slow_support = std::bit_cast<double>(word_at(bytes, 5));
  state.fast_support = std::bit_cast<double>(word_at(bytes, 6));
  state.particles.resize(count);
  std::size_t at = kWordBytes * kHeaderWords;
  for (auto* column : columns_of(state.particles)) {
    std::memcpy(column->data(), bytes.data() + at, kWordBytes * count);
    at += kWordBytes * count;
    if (!std::ranges::all_of(*column, [](double x) { return std::isfinite(x); })) refuse("holds what is no number");
  }
  constexpr double kRounding = 1e-6;  // of weights that sum to 1
  const std::vector<double>& weights = state.particles.weight;
  const bool has_weights = std::ranges::all_of(weights, [](double w) { return w >= 0.0 && w <= 1.0; }) &&
                           std::abs(std::accumulate(weights.begin(), weights.end(), -1.0)) <= kRounding;
  const bool has_scales = std::ranges::all_of(state.particles.log_scale, [](double s) { return std::abs(s) <= 1.0; });
  const bool has_support =
      state.slow_support > 0.0 && state.slow_support <= 1.0 && state.fast_support >= 0.0 && state.fast_support <= 1.0;
  if (!has_support || !has_weights || !has_scales) {
    refuse("holds values that no filter has");
  }
  return state;
}

}  // namespace roadfix
