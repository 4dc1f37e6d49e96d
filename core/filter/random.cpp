#include "core/filter/random.hpp"

#include <cmath>
#include <numbers>

namespace roadfix {
namespace {

constexpr std::uint64_t kGoldenGamma = 0x9e3779b97f4a7c15ULL;

constexpr std::uint64_t mixed(std::uint64_t z) {
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31U);
}

}  // namespace

RandomStream::RandomStream(Draw purpose, const Address& address)
    : state_(mixed(mixed(mixed(address.seed + kGoldenGamma * static_cast<std::uint64_t>(purpose)) + kGoldenGamma +
                         address.step) +
                   kGoldenGamma + address.index)) {}

std::uint64_t RandomStream::next() {
  state_ += kGoldenGamma;
  return mixed(state_);
}

double RandomStream::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
  const double direction = 2.0 * std::numbers::pi * uniform();
  spare_ = radius * std::sin(direction);
  has_spare_ = true;
  return radius * std::cos(direction);
}

}  // namespace roadfix
