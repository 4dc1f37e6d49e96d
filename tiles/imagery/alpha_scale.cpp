#include "tiles/imagery/alpha_scale.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace roadfix {
namespace {

constexpr double kByte = 255.0;
constexpr double kFaint = 0.02;  // of full

double largest_opacity(GDALDataType type) {
  switch (type) {
    case GDT_Byte:
      return kByte;
    case GDT_UInt16:
      return 65535.0;
    case GDT_Int16:
      return 32767.0;
    default:
      return 1.0;
  }
}

double full_opacity(double largest, GDALDataType type) {
  if (type == GDT_Byte) return kByte;
  if (largest > 0.0 && largest <= 1.0) return 1.0;
  return largest > 0.0 && largest <= kByte ? kByte : largest_opacity(type);
}

/// Whether no value, nor what lies as near to it as lossy compression leaves an alpha, makes up half of those that are
/// not transparent: what an image shows is opaque but for its rims, or as opaque everywhere.
bool are_varied(const std::vector<float>& samples, double largest) {
  constexpr std::size_t kSteps = 50;
  std::array<std::size_t, kSteps + 1> counts{};
  std::size_t above_zero = 0;
  for (const float sample : samples) {
    const auto value = static_cast<double>(sample);
    if (!(value > 0.0)) continue;
    ++above_zero;
    ++counts.at(static_cast<std::size_t>(std::lround(kSteps * (1.0 - value / largest))));
  }
  return 2 * *std::ranges::max_element(counts) < above_zero;
}

}  // namespace

AlphaScale alpha_scale(const std::vector<float>& samples, GDALDataType type) {
  double largest = 0.0;
  for (const float value : samples) largest = std::max(largest, static_cast<double>(value));
  AlphaScale scale{full_opacity(largest, type)};
  const auto is_graded = [&](double value) {
    return value > kFaint * scale.full && value < (1.0 - kFaint) * scale.full;
  };
  if (!samples.empty()) {
    scale.graded = static_cast<double>(std::ranges::count_if(samples, is_graded)) / static_cast<double>(samples.size());
  }
  scale.varied = std::isfinite(largest) && are_varied(samples, largest);
  if (scale.varied) scale.full = 2.0 * kFaint * std::min(kByte, scale.full);
  return scale;
}

}  // namespace roadfix
