#include "core/scan/fourier.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <complex>
#include <numbers>
#include <random>

namespace roadfix {
namespace {

ComplexPlane noise(int side, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<float> values(-1.0F, 1.0F);
  ComplexPlane plane(side);
  for (int row = 0; row < side; ++row) {
    for (int col = 0; col < side; ++col) {
      plane.re(row)[col] = values(random);
      plane.im(row)[col] = values(random);
    }
  }
  return plane;
}

std::complex<double> at(const ComplexPlane& plane, int col, int row) {
  return {static_cast<double>(plane.re(row)[col]), static_cast<double>(plane.im(row)[col])};
}

constexpr std::array<int, 10> kSides{16, 32, 48, 64, 96, 128, 192, 256, 384, 512};

Spectrum spectrum_of(const ComplexPlane& plane) {
  Spectrum spectrum(plane.side());
  ComplexPlane scratch(plane.side());
  FourierTransform(plane.side()).forward(plane, {plane.side(), plane.side()}, scratch, spectrum);
  return spectrum;
}

TEST(FourierTransform, TakesPowersOfTwoAndThreeTimesThoseForASide) {
  for (const int side : kSides) EXPECT_TRUE(FourierTransform::is_side(side)) << side;
  for (const int side : {0, 8, 24, 40, 80, 144, 9}) EXPECT_FALSE(FourierTransform::is_side(side)) << side;
}

TEST(FourierTransform, BackwardBringsBackWhatForwardTook) {
  for (const int side : kSides) {
    const ComplexPlane before = noise(side, 1);
    ComplexPlane one(side);
    one.re(0)[0] = 1.0F;
    ComplexPlane plane(side);
    ComplexPlane scratch(side);
    FourierTransform(side).backward_of_product(spectrum_of(before), spectrum_of(one), false, {0, side}, plane, scratch);
    const double cells = double{1} * side * side;
    for (int row = 0; row < side; ++row) {
      for (int col = 0; col < side; ++col) {
        ASSERT_LT(std::abs(at(plane, col, row) / cells - at(before, col, row)), 1e-5) << side;
      }
    }
  }
}

TEST(FourierTransform, TakesAWaveToOneNumber) {
  for (const int side : kSides) {
    ComplexPlane plane(side);
    for (int row = 0; row < side; ++row) {
      for (int col = 0; col < side; ++col) {
        const double angle = 2.0 * std::numbers::pi * (3 * col + 5 * row) / side;
        plane.re(row)[col] = static_cast<float>(std::cos(angle));
        plane.im(row)[col] = static_cast<float>(std::sin(angle));
      }
    }
    const Spectrum spectrum = spectrum_of(plane);
    const double cells = double{1} * side * side;
    int ones = 0;
    for (int strip = 0; strip < side / kStripCols; ++strip) {
      const float* values = spectrum.strip(strip);
      for (int row = 0; row < side; ++row, values += std::ptrdiff_t{2} * kStripCols) {
        for (int col = 0; col < kStripCols; ++col) {
          const std::complex<double> value(static_cast<double>(values[col]) / cells,
                                           static_cast<double>(values[kStripCols + col]) / cells);
          if (std::abs(value) > 0.5) {
            ++ones;
            EXPECT_NEAR(value.real(), 1.0, 1e-5);
          } else {
            ASSERT_LT(std::abs(value), 1e-5);
          }
        }
      }
    }
    EXPECT_EQ(ones, 1) << side;
  }
}

TEST(FourierTransform, MindsOnlyThePartThatIsFilled) {
  constexpr int kSide = 96;
  ComplexPlane part = noise(kSide, 4);
  ComplexPlane scratch = noise(kSide, 5);
  Spectrum spectrum(kSide);
  FourierTransform(kSide).forward(part, {32, 21}, scratch, spectrum);
  ComplexPlane whole(kSide);
  for (int row = 0; row < 21; ++row) {
    std::copy_n(part.re(row), 32, whole.re(row));
    std::copy_n(part.im(row), 32, whole.im(row));
  }
  const Spectrum expected = spectrum_of(whole);
  for (int strip = 0; strip < kSide / kStripCols; ++strip) {
    for (int i = 0; i < 2 * kStripCols * kSide; ++i) ASSERT_EQ(spectrum.strip(strip)[i], expected.strip(strip)[i]);
  }
}

/// Sum of a(k -+ x) b(x), cyclic.
std::complex<double> cyclic_sum(const ComplexPlane& a, const ComplexPlane& b, int col, int row, int sign) {
  const int side = a.side();
  std::complex<double> sum;
  for (int r = 0; r < side; ++r) {
    for (int c = 0; c < side; ++c) {
      sum += at(a, (col + sign * c + side) % side, (row + sign * r + side) % side) * at(b, c, r);
    }
  }
  return sum;
}

void expect_cyclic_sums(int side) {
  const FourierTransform fourier(side);
  const ComplexPlane a = noise(side, 2);
  const ComplexPlane b = noise(side, 3);
  const Spectrum spectrum_a = spectrum_of(a);
  const Spectrum spectrum_b = spectrum_of(b);
  ComplexPlane scratch(side);
  ComplexPlane sums(side);
  fourier.backward_of_product(spectrum_a, spectrum_b, false, {0, side}, sums, scratch);
  ComplexPlane conjugate_b = b;
  for (int row = 0; row < side; ++row) {
    for (int col = 0; col < side; ++col) conjugate_b.im(row)[col] *= -1.0F;
  }
  ComplexPlane others(side);
  fourier.backward_of_product(spectrum_a, spectrum_b, true, {0, side}, others, scratch);
  ComplexPlane some(side);
  fourier.backward_of_product(spectrum_a, spectrum_b, true, {9, 19}, some, scratch);
  for (int row = 0; row < side; ++row) {
    for (int col = 9; col < 19; ++col) EXPECT_EQ(at(some, col, row), at(others, col, row));
  }
  const double cells = double{1} * side * side;
  for (const int place : {0, 1, 17, side - 1}) {
    const int other = (place * 7) % side;
    EXPECT_LT(std::abs(at(sums, place, other) / cells - cyclic_sum(a, b, place, other, -1)), 1e-3);
    EXPECT_LT(std::abs(at(others, place, other) / cells - cyclic_sum(a, conjugate_b, place, other, 1)), 1e-3);
  }
}

TEST(FourierTransform, ProductsOfSpectraAreCyclicSums) {
  expect_cyclic_sums(32);
  expect_cyclic_sums(48);
  expect_cyclic_sums(64);
}

}  // namespace
}  // namespace roadfix
