#include "tiles/imagery/picture_range.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>

namespace roadfix {
namespace {

constexpr double kBeyondRange = 0.005;  // of the values, at either end

/// The more frequent one of the two ends of the values, if it is frequent and the rest differ.
std::optional<float> fill_of(const std::vector<float>& values) {
  if (values.empty()) return std::nullopt;
  const auto [low, high] = std::ranges::minmax(values);
  if (std::ranges::all_of(values, [&, a = low, b = high](float v) { return v == a || v == b; })) return std::nullopt;
  const std::ptrdiff_t dark = std::ranges::count(values, low);
  const std::ptrdiff_t bright = std::ranges::count(values, high);
  if (static_cast<double>(std::max(dark, bright)) < kBeyondRange * static_cast<double>(values.size())) {
    return std::nullopt;
  }
  return dark >= bright ? low : high;
}

}  // namespace

void ThinnedValues::add(const std::vector<float>& values) {
  for (; skip_ < values.size(); skip_ += step_) {
    kept_.push_back(values[skip_]);
    if (kept_.size() < most_) continue;
    for (std::size_t i = 0; i < kept_.size() / 2; ++i) kept_[i] = kept_[2 * i];
    kept_.resize(kept_.size() / 2);
    step_ *= 2;
  }
  skip_ -= values.size();
}

std::vector<float> without_fill(std::vector<float> values) {
  if (const std::optional<float> fill = fill_of(values)) std::erase(values, *fill);
  return values;
}

ValueRange percentile_range(std::vector<float> values) {
  if (values.empty()) return {0.0, 1.0};
  const auto at = [&values](double share) {
    const auto index = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + index, values.end());
    return static_cast<double>(values[static_cast<std::size_t>(index)]);
  };
  const double low = at(kBeyondRange);
  const double high = at(1.0 - kBeyondRange);
  return {low, high > low ? high : low + 1.0};
}

}  // namespace roadfix
