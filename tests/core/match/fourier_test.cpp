#include "core/match/fourier.hpp"

#include <gtest/gtest.h>

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

TEST(FourierTransform, BackwardBringsBackWhatForwardTook) {
  for (const int side : {16, 32, 64, 128, 256}) {
    const FourierTransform fourier(side);
    const ComplexPlane before = noise(side, 1);
    ComplexPlane plane = before;
    ComplexPlane scratch(side);
    fourier.forward(plane, scratch);
    fourier.backward(plane, scratch);
    const double cells = double{1} * side * side;
    for (int row = 0; row < side; ++row) {
      for (int col = 0; col < side; ++col) {
        ASSERT_LT(std::abs(at(plane, col, row) / cells - at(before, col, row)), 1e-5) << side;
      }
    }
  }
}

TEST(FourierTransform, TakesAWaveToOneNumber) {
  for (const int side : {16, 32, 64}) {
    ComplexPlane plane(side);
    for (int row = 0; row < side; ++row) {
      for (int col = 0; col < side; ++col) {
        const double angle = 2.0 * std::numbers::pi * (3 * col + 5 * row) / side;
        plane.re(row)[col] = static_cast<float>(std::cos(angle));
        plane.im(row)[col] = static_cast<float>(std::sin(angle));
      }
    }
    ComplexPlane scratch(side);
    FourierTransform(side).forward(plane, scratch);
    const double cells = double{1} * side * side;
    int ones = 0;
    for (int row = 0; row < side; ++row) {
      for (int col = 0; col < side; ++col) {
        const double size = std::abs(at(plane, col, row)) / cells;
        if (size > 0.5) {
          ++ones;
          EXPECT_NEAR(at(plane, col, row).real() / cells, 1.0, 1e-5);
        } else {
          ASSERT_LT(size, 1e-5);
        }
      }
    }
    EXPECT_EQ(ones, 1);
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

TEST(FourierTransform, ProductsOfSpectraAreCyclicSums) {
  constexpr int kSide = 32;
  const FourierTransform fourier(kSide);
  const ComplexPlane a = noise(kSide, 2);
  const ComplexPlane b = noise(kSide, 3);
  ComplexPlane scratch(kSide);
  ComplexPlane spectrum_a = a;
  ComplexPlane spectrum_b = b;
  fourier.forward(spectrum_a, scratch);
  fourier.forward(spectrum_b, scratch);
  ComplexPlane sums(kSide);
  fourier.backward_of_product(spectrum_a, spectrum_b, false, {0, kSide}, sums, scratch);
  ComplexPlane conjugate_b = b;
  for (int row = 0; row < kSide; ++row) {
    for (int col = 0; col < kSide; ++col) conjugate_b.im(row)[col] *= -1.0F;
  }
  ComplexPlane others(kSide);
  fourier.backward_of_product(spectrum_a, spectrum_b, true, {0, kSide}, others, scratch);
  ComplexPlane some(kSide);
  fourier.backward_of_product(spectrum_a, spectrum_b, true, {9, 19}, some, scratch);
  for (int row = 0; row < kSide; ++row) {
    for (int col = 9; col < 19; ++col) EXPECT_EQ(at(some, col, row), at(others, col, row));
  }
  constexpr double kCells = kSide * kSide;
  for (const int place : {0, 1, 17, 31}) {
    const int other = (place * 7) % kSide;
    EXPECT_LT(std::abs(at(sums, place, other) / kCells - cyclic_sum(a, b, place, other, -1)), 1e-3);
    EXPECT_LT(std::abs(at(others, place, other) / kCells - cyclic_sum(a, conjugate_b, place, other, 1)), 1e-3);
  }
}

}  // namespace
}  // namespace roadfix
