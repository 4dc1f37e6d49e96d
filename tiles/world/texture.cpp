#include "tiles/world/texture.hpp"

#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tiles/world/random.hpp"

namespace roadfix::world {
namespace {

// Two sizes without a common factor: their sum repeats only after more than a million pixels.
constexpr int kGrainSide = 1021;
constexpr int kPatchSide = 1536;
constexpr double kTextureGsdM = 0.5;

struct Amplitude {
  float grain;
  float patches;
};

/// In the order of Material.
constexpr std::array<Amplitude, 8> kAmplitudes{{{0.05F, 0.09F},
                                                {0.045F, 0.05F},
                                                {0.02F, 0.035F},
                                                {0.07F, 0.10F},
                                                {0.06F, 0.05F},
                                                {0.20F, 0.10F},
                                                {0.02F, 0.02F},
                                                {0.16F, 0.10F}}};

int wrap(int value, int side) {
  const int rest = value % side;
  return rest < 0 ? rest + side : rest;
}

cv::Mat1f white_noise(int side, Random& random) {
  cv::Mat1f noise(side, side);
  for (float& value : noise) value = static_cast<float>(random.normal());
  return noise;
}

/// Deviation 1, periodic.
cv::Mat1f smoothed(const cv::Mat1f& noise, double sigma) {
  const int margin = static_cast<int>(4.0 * sigma) + 1;
  cv::Mat1f wide;
  cv::copyMakeBorder(noise, wide, margin, margin, margin, margin, cv::BORDER_WRAP);
  cv::GaussianBlur(wide, wide, {}, sigma);
  cv::Mat1f result = wide(cv::Rect(margin, margin, noise.cols, noise.rows)).clone();
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(result, mean, deviation);
  result.convertTo(result, CV_32F, 1.0 / deviation[0], -mean[0] / deviation[0]);
  return result;
}

/// A periodic table with `step` values for each one, smooth in between.
cv::Mat1f enlarged(const cv::Mat1f& table, int step) {
  constexpr int kMargin = 4;
  cv::Mat1f wide;
  cv::copyMakeBorder(table, wide, kMargin, kMargin, kMargin, kMargin, cv::BORDER_WRAP);
  cv::resize(wide, wide, {}, step, step, cv::INTER_CUBIC);
  return wide(cv::Rect(kMargin * step, kMargin * step, table.cols * step, table.rows * step));
}

}  // namespace

Texture::Texture(std::uint64_t seed) {
  Random random(seed, 91);
  grain_ = white_noise(kGrainSide, random);
  patches_ = cv::Mat1f::zeros(kPatchSide, kPatchSide);
  for (const int step : {2, 8, 24})
    patches_ += enlarged(smoothed(white_noise(kPatchSide / step, random), 2.0), step) / 1.732;
}

float Texture::grain(int col, int row, int shift) const {
  return grain_(wrap(row + shift * 389, kGrainSide), wrap(col + shift * 577 + (row / kGrainSide) * 101, kGrainSide));
}

float Texture::patches(int x, int y) const { return patches_(wrap(y, kPatchSide), wrap(x, kPatchSide)); }

void Texture::apply(cv::Mat3b& colour, const cv::Mat1b& material, cv::Rect pixels, double gsd_m) const {
  const double scale = gsd_m / kTextureGsdM;
  for (int row = 0; row < colour.rows; ++row) {
    const int y = static_cast<int>(std::lround((pixels.y + row) * scale));
    for (int col = 0; col < colour.cols; ++col) {
      const int x = static_cast<int>(std::lround((pixels.x + col) * scale));
      const Amplitude amplitude = kAmplitudes[material(row, col)];
      const float factor = 1.0F + amplitude.grain * grain(x, y, 0) + amplitude.patches * patches(x, y);
      for (int i = 0; i < 3; ++i) {
        std::uint8_t& channel = colour(row, col)[i];
        channel = cv::saturate_cast<std::uint8_t>(static_cast<float>(channel) * factor);
      }
    }
  }
}

}  // namespace roadfix::world
