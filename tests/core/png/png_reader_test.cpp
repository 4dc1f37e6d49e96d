#include "core/png/png_reader.hpp"

#include <gmock/gmock.h>

#include <random>

#include "core/png/plain_png.hpp"
#include "core/units/error.hpp"
#include "tests/support/code_of.hpp"

namespace roadfix {
namespace {

using testing::code_of;

std::vector<std::uint8_t> noise(const PngShape& shape) {
  std::vector<std::uint8_t> pixels(shape.bytes());
  std::mt19937 random(1);
  for (std::uint8_t& pixel : pixels) pixel = static_cast<std::uint8_t>(random());
  return pixels;
}

std::vector<std::uint8_t> decoded(std::span<const std::byte> png, PngOrigin origin) {
  PngReader reader(png, origin);
  std::vector<std::uint8_t> pixels(reader.shape().bytes());
  reader.read(pixels);
  return pixels;
}

std::vector<std::byte> as_bytes(std::initializer_list<int> values) {
  std::vector<std::byte> bytes;
  for (const int value : values) bytes.push_back(static_cast<std::byte>(value));
  return bytes;
}

TEST(PngReader, SixteenBitsFromOutsideAreNumbersOfThisProcessor) {
  const PngShape shape{2, 1, 1, 16};
  const auto png = encode_plain_png(std::vector<std::uint8_t>{0x12, 0x34, 0xab, 0xcd}, shape);
  const auto pixels = decoded(png, PngOrigin::kOutside);
  const auto* numbers = reinterpret_cast<const std::uint16_t*>(pixels.data());
  EXPECT_THAT(std::span(numbers, 2), ::testing::ElementsAre(0x1234, 0xabcd));
}

TEST(PngReader, TheShapeIsKnownBeforeAnyPixelIsThere) {
  const PngShape shape{100, 80, 1, 8};
  const auto png = encode_plain_png(noise(shape), shape);
  constexpr std::size_t kHeaderEnd = 33 + 8;  // and the name of the chunk of pixels
  PngReader reader({png.data(), kHeaderEnd}, PngOrigin::kOwn);
  EXPECT_EQ(reader.shape(), shape);
  std::vector<std::uint8_t> pixels(shape.bytes());
  EXPECT_EQ(code_of([&] { reader.read(pixels); }), "png-damaged");
}

TEST(PngReader, WhatItWouldNotWriteIsNotItsOwn) {
  // 2 x 1 pixels of one bit, 0 and 1, of the palette red and green.
  const auto palette =
      as_bytes({0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00,
                0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x01, 0x01, 0x03, 0x00, 0x00, 0x00, 0xce, 0xec, 0xed, 0xc9, 0x00,
                0x00, 0x00, 0x06, 0x50, 0x4c, 0x54, 0x45, 0xff, 0x00, 0x00, 0x00, 0xff, 0x00, 0xd2, 0x87, 0xef, 0x71,
                0x00, 0x00, 0x00, 0x0a, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0x70, 0x00, 0x00, 0x00, 0x42, 0x00,
                0x41, 0x29, 0x37, 0xf4, 0xef, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82});
  EXPECT_THAT(decoded(palette, PngOrigin::kOutside), ::testing::ElementsAre(0, 0, 255, 0, 255, 0));
  EXPECT_EQ(code_of([&] { decoded(palette, PngOrigin::kOwn); }), "png-damaged");
}

TEST(PngReader, BytesAfterTheEndArePassedOverFromOutsideAlone) {
  const PngShape shape{4, 4, 1, 8};
  auto png = encode_plain_png(noise(shape), shape);
  png.push_back(std::byte{0});
  EXPECT_EQ(decoded(png, PngOrigin::kOutside), noise(shape));
  EXPECT_EQ(code_of([&] { decoded(png, PngOrigin::kOwn); }), "png-damaged");
}

}  // namespace
}  // namespace roadfix
