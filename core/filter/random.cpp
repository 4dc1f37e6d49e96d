#include "core/filter/random.hpp"

#include <cmath>
#include <numbers>

namespace roadfix {

RandomStream::RandomStream(Draw purpose, const Address& address)
    : bits_(mix64(mix64(mix64(address.seed + kGoldenGamma * static_cast<std::uint64_t>(purpose)) + kGoldenGamma +
                        address.step) +
                  kGoldenGamma + address.index)) {}

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
