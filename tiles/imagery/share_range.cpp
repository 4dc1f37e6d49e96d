#include "tiles/imagery/share_range.hpp"

#include <algorithm>
#include <optional>

namespace roadfix {

SampledShares sampled_shares(const std::vector<float>& values) {
  const float max = values.empty() ? 0.0F : *std::ranges::max_element(values);
  return {max, std::ranges::all_of(values, [max](float v) { return v == 0.0F || v == max; })};
}

bool look_beyond_samples(RasterFile& file, SampledShares& sampled) {
  if (!file.holds_integers() || file.has_palette()) return false;
  const std::optional<ValueRange> declared = file.declared_range();
  const float half = declared ? 127.0F : 32767.0F;  // of what the type can hold: above it nothing is open
  if (sampled.max > half || (declared && declared->high <= 1.0)) return false;
  const float largest = file.largest_value(half);
  if (largest <= sampled.max) return false;
  sampled.mask = sampled.mask && sampled.max <= 0.0F;
  sampled.max = largest;
  return true;
}

std::vector<float> telling_values(const std::vector<float>& values) {
  if (values.empty()) return {};
  const auto [min, max] = std::ranges::minmax(values);
  std::vector<float> telling{min, max};
  float above_one = max;
  for (const float v : values) {
    if (v > 1.0F) above_one = std::min(above_one, v);
  }
  telling.push_back(above_one);
  if (std::ranges::find(values, 1.0F) != values.end()) telling.push_back(1.0F);
  return telling;
}

ValueRange share_range(const std::vector<float>& values, bool integers) {
  if (!integers) return {0.0, 1.0};
  const float largest = values.empty() ? 0.0F : *std::ranges::max_element(values);
  if (largest <= 1.0F) return {0.0, 1.0};
  return {0.0, largest <= 255.0F ? 255.0 : 65535.0};
}

bool are_ones_only(const std::vector<float>& values, float largest) {
  const auto between = [&](float v) { return v > 1.0F && v < largest; };
  return largest > 1.0F && std::ranges::find(values, 1.0F) != values.end() && std::ranges::none_of(values, between);
}

}  // namespace roadfix
