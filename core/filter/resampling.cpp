#include "core/filter/resampling.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>

namespace roadfix {

double effective_sample_size(std::span<const double> weights) {
  double squares = 0.0;
  for (const double w : weights) squares += w * w;
  return squares > 0.0 ? 1.0 / squares : 0.0;
}

std::vector<std::size_t> systematic_ancestors(std::span<const double> weights, std::size_t count, double offset) {
  assert(!weights.empty() && offset >= 0.0 && offset < 1.0);
  std::vector<std::size_t> ancestors(count);
  std::size_t i = 0;
  double reached = weights[0];
  for (std::size_t k = 0; k < count; ++k) {
    const double target = (static_cast<double>(k) + offset) / static_cast<double>(count);
    while (reached <= target && i + 1 < weights.size()) reached += weights[++i];
    ancestors[k] = i;
  }
  return ancestors;
}

double kld_sample_count(std::size_t bins) {
  constexpr double kError = 0.05;
  constexpr double kQuantile = 2.3263;  // of 0.99, standard normal
  if (bins < 2) return 1.0;
  const double k = static_cast<double>(bins) - 1.0;
  const double share = 2.0 / (9.0 * k);
  return k / (2.0 * kError) * std::pow(1.0 - share + std::sqrt(share) * kQuantile, 3.0);
}

std::size_t occupied_bins(const Particles& particles, std::span<const std::size_t> chosen) {
  constexpr double kBinM = 20.0;
  constexpr double kBinLogScale = 0.05;
  const double bin_rad = Angle::degrees(10.0).radians();
  using Bin = std::array<std::int64_t, 4>;
  const auto bin = [](double value, double size) { return static_cast<std::int64_t>(std::floor(value / size)); };
  std::vector<Bin> bins;
  for (std::size_t n = 0; n < chosen.size(); ++n) {
    const std::size_t i = chosen[n];
    if (n > 0 && i == chosen[n - 1]) continue;
    bins.push_back({bin(particles.east_m[i], kBinM), bin(particles.north_m[i], kBinM),
                    bin(particles.heading_rad[i], bin_rad), bin(particles.log_scale[i], kBinLogScale)});
  }
  std::ranges::sort(bins);
  return static_cast<std::size_t>(std::distance(bins.begin(), std::unique(bins.begin(), bins.end())));
}

}  // namespace roadfix
