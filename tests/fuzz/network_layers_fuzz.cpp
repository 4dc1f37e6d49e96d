// A user's own network: any bytes are either layers that fit together for some size, or none.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "core/network/layers.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto layers = roadfix::read_layers({data, size});
  if (!layers) return 0;
  if (layers->empty() || layers->back().channels != 1) std::abort();
  const auto sides = roadfix::output_sides(*layers, {64, 48});
  if (sides && (sides->at(0) < 1 || sides->at(1) < 1)) std::abort();
  return 0;
}
