#include "tiles/world/light.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tiles/world/palette.hpp"

namespace roadfix::world {
namespace {

constexpr float kTallerM = 0.4F;  // what is no more than this above the ground casts no shadow that is seen
constexpr double kMiddleGrey = 128.0;

/// One row of the sweep: the height of the shadow's upper edge above each pixel.
void sweep_row(const float* height, const float* before, float shift, float drop, int count, float* edge) {
  const int whole = static_cast<int>(std::floor(shift));
  const float part = shift - static_cast<float>(whole);
  for (int i = 0; i < count; ++i) {
    float coming = 0.0F;
    const int from = i - whole;
    if (from - 1 >= 0 && from < count) coming = before[from] * (1.0F - part) + before[from - 1] * part - drop;
    edge[i] = std::max(height[i], coming);
  }
}

/// Share of dust in the air over each pixel: plumes over debris, uneven.
cv::Mat1f air(cv::Rect pixels, double gsd_m, const Conditions& conditions, const std::vector<Debris>& debris,
              const Texture& texture) {
  constexpr int kStep = 8;
  const double reach = 90.0;
  cv::Mat1f coarse((pixels.height + kStep - 1) / kStep + 1, (pixels.width + kStep - 1) / kStep + 1, 0.0F);
  const auto plan_of = [&](int col, int row) {
    return PlanPoint((pixels.x + col * kStep) * gsd_m, (pixels.y + row * kStep) * gsd_m);
  };
  const cv::Rect2d area(pixels.x * gsd_m - reach, pixels.y * gsd_m - reach, pixels.width * gsd_m + 2.0 * reach,
                        pixels.height * gsd_m + 2.0 * reach);
  std::vector<const Debris*> near;
  for (const Debris& d : debris) {
    if (area.contains(d.footprint.centre)) near.push_back(&d);
  }
  for (int row = 0; row < coarse.rows; ++row) {
    for (int col = 0; col < coarse.cols; ++col) {
      const PlanPoint p = plan_of(col, row);
      double thickness = 0.0;
      for (const Debris* d : near) {
        const double distance = cv::norm(d->footprint.centre - p);
        if (distance < reach) thickness += 0.05 * (1.0 - distance / reach);
      }
      const double uneven =
          1.0 + 0.35 * static_cast<double>(texture.patches(static_cast<int>(p.x / 5.0), static_cast<int>(p.y / 5.0)));
      coarse(row, col) = static_cast<float>(
          std::clamp(conditions.haze * uneven + std::min(thickness * uneven, 0.22) * conditions.winter, 0.0, 0.5));
    }
  }
  cv::Mat1f fine;
  cv::resize(coarse, fine, {}, kStep, kStep, cv::INTER_LINEAR);
  return fine;
}

}  // namespace

cv::Mat1b cast_shadows(const cv::Mat1f& height, double gsd_m, const Conditions& conditions) {
  const PlanPoint fall = conditions.shadow_direction();
  const bool by_columns = std::abs(fall.x) > std::abs(fall.y);
  cv::Mat1f field = by_columns ? cv::Mat1f(height.t()) : height;
  const double main = by_columns ? fall.x : fall.y;
  const double other = by_columns ? fall.y : fall.x;
  const auto shift = static_cast<float>(other / std::abs(main));
  const auto drop = static_cast<float>(gsd_m / std::abs(main) / conditions.shadow_length());
  cv::Mat1f edge = field.clone();
  for (int k = 1; k < field.rows; ++k) {
    const int row = main > 0.0 ? k : field.rows - 1 - k;
    const int before = main > 0.0 ? row - 1 : row + 1;
    sweep_row(field[row], edge[before], shift, drop, field.cols, edge[row]);
  }
  cv::Mat1b shadow;
  cv::compare(edge, field + static_cast<double>(kTallerM), shadow, cv::CMP_GT);
  if (by_columns) cv::transpose(shadow.clone(), shadow);
  cv::GaussianBlur(shadow, shadow, {}, 0.6);
  return shadow;
}

void shade(cv::Mat3b& colour, const cv::Mat1b& shadow) {
  const cv::Vec3f ambient(0.36F, 0.40F, 0.46F);
  for (int row = 0; row < colour.rows; ++row) {
    for (int col = 0; col < colour.cols; ++col) {
      if (shadow(row, col) == 0) continue;
      const float share = static_cast<float>(shadow(row, col)) / 255.0F;
      for (int i = 0; i < 3; ++i) {
        std::uint8_t& channel = colour(row, col)[i];
        channel = cv::saturate_cast<std::uint8_t>(static_cast<float>(channel) * (1.0F - share * (1.0F - ambient[i])));
      }
    }
  }
}

void expose(cv::Mat3b& colour, cv::Rect pixels, double gsd_m, const Conditions& conditions,
            const std::vector<Debris>& debris, const Texture& texture) {
  const cv::Mat1f thickness = air(pixels, gsd_m, conditions, debris, texture);
  cv::GaussianBlur(colour, colour, {}, conditions.blur_px);
  for (int row = 0; row < colour.rows; ++row) {
    for (int col = 0; col < colour.cols; ++col) {
      const auto scattered = static_cast<double>(thickness(row, col));
      const double noise = conditions.noise *
                           static_cast<double>(texture.grain(pixels.x + col, pixels.y + row, conditions.noise_stream));
      for (int i = 0; i < 3; ++i) {
        std::uint8_t& channel = colour(row, col)[i];
        const double hazy = channel * (1.0 - scattered) + palette::kDust[i] * scattered;
        const double seen = ((hazy - kMiddleGrey) * conditions.contrast + kMiddleGrey) * conditions.gain[i] + noise;
        channel = cv::saturate_cast<std::uint8_t>(seen);
      }
    }
  }
}

}  // namespace roadfix::world
