// What one request may ask for. Advertised at GET /v1/limits.
#pragma once

#include <cstdint>

namespace roadfix::api {

struct Limits {
  std::int64_t pixels = 40'000'000;  ///< of a frame or picture, before and after rectification
  std::int64_t cells = 16'000'000;   ///< of a window or feature map
  int poses = 100'000;
  double search_km2 = 2'000.0;
  int modes = 64;
  int particles = 50'000;  ///< of a track
  int frames = 16;         ///< laid together in one request
};

}  // namespace roadfix::api
