#include "core/detect/feature_map_codec.hpp"
#include "core/units/error.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::int64_t kMaxPixels = 1 << 20;
  try {
    (void)roadfix::decode_feature_map({data, size}, kMaxPixels);
  } catch (const roadfix::Error&) {
    // refused with a reason: what a decoder is for
  }
  return 0;
}
