#include "core/filter/random.hpp"

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
  const double u = uniform();
  const auto [number, spare] = normal_pair(u, uniform());
  spare_ = spare;
  has_spare_ = true;
  return number;
}

}  // namespace roadfix
