#include "core/png/plain_png.hpp"

#include <gmock/gmock.h>

#include <map>
#include <optional>
#include <random>
#include <string>

#include "core/png/png_chunk.hpp"
#include "core/units/error.hpp"
#include "tests/support/decoded_png.hpp"
#include "tests/support/png_of_rows.hpp"

namespace roadfix {
namespace {

using ::testing::ElementsAre;
using ::testing::Optional;
using testing::packed_by_zlib;
using testing::png_of_chunks;
using testing::png_of_rows;
using testing::PngHeader;
using Pixels = std::vector<std::uint8_t>;

constexpr PngShape kShape{6, 5, 1, 16};
constexpr PngHeader kHeader{6, 5, 16, 0, 0};
constexpr std::size_t kRowBytes = 12;

Pixels random_pixels(const PngShape& shape) {
  Pixels pixels(shape.bytes());
  std::mt19937 random(1);
  for (std::uint8_t& pixel : pixels) pixel = static_cast<std::uint8_t>(random());
  return pixels;
}

/// Rows of kShape, of noise, after a filter type each.
std::string filtered(std::initializer_list<char> types) {
  std::mt19937 random(2);
  std::string rows;
  for (const char type : types) {
    rows.push_back(type);
    for (std::size_t i = 0; i < kRowBytes; ++i) rows.push_back(static_cast<char>(random()));
  }
  return rows;
}

std::optional<Pixels> read_fast(std::span<const std::byte> png, const PngShape& shape = kShape) {
  Pixels pixels(shape.bytes(), 7);
  return read_plain_png(png, shape, pixels) ? std::optional(pixels) : std::nullopt;
}

/// By libpng. nullopt where it refuses.
std::optional<Pixels> read_otherwise(std::span<const std::byte> png) {
  try {
    PngReader reader(png, PngOrigin::kOwn);
    Pixels pixels(reader.shape().bytes());
    reader.read(pixels);
    return pixels;
  } catch (const CorruptData&) {
    return std::nullopt;
  }
}

TEST(PlainPng, ComesBackAsItWasAlsoByLibpng) {
  for (const PngShape& shape :
       {PngShape{1, 1, 1, 8}, PngShape{7, 3, 1, 8}, PngShape{5, 64, 1, 16}, PngShape{300, 300, 1, 16}}) {
    const auto png = encode_plain_png(random_pixels(shape), shape);
    EXPECT_THAT(read_fast(png, shape), Optional(random_pixels(shape)));
    EXPECT_THAT(read_otherwise(png), Optional(random_pixels(shape)));
    EXPECT_EQ(encode_plain_png(random_pixels(shape), shape), png);
  }
}

TEST(PlainPng, WithAlphaOrColoursIsThatOfOtherPrograms) {
  for (const int channels : {2, 3, 4}) {
    const PngShape shape{7, 3, channels, 8};
    const Pixels pixels = random_pixels(shape);
    const cv::Mat picture = testing::decoded_png(encode_plain_png(pixels, shape));
    ASSERT_EQ(picture.size(), cv::Size(7, 3));
    ASSERT_EQ(picture.channels(), channels == 2 ? 4 : channels) << "OpenCV repeats the grey";
    for (int i = 0; i < 21; ++i) {
      const auto* const read = picture.ptr<std::uint8_t>(i / 7, i % 7);  // blue, green, red, alpha
      const std::uint8_t* const written = pixels.data() + static_cast<std::ptrdiff_t>(i) * channels;
      const bool grey = channels == 2;
      EXPECT_THAT(std::vector(read, read + 3), ElementsAre(written[grey ? 0 : 2], written[grey ? 0 : 1], written[0]));
      if (channels != 3) {
        EXPECT_EQ(read[3], written[channels - 1]);
      }
    }
  }
}

TEST(PlainPng, DifferencesFromTheRowAboveAreReadAsLibpngReadsThem) {
  for (const auto& rows : {filtered({0, 0, 0, 0, 0}), filtered({2, 2, 2, 2, 2}), filtered({0, 2, 2, 0, 2})}) {
    const auto png = png_of_rows(kHeader, rows);
    ASSERT_TRUE(read_fast(png));
    EXPECT_EQ(read_fast(png), read_otherwise(png));
  }
}

TEST(PlainPng, PixelsMayBeInManyChunks) {
  const std::string packed = packed_by_zlib(filtered({0, 2, 0, 2, 0}));
  std::string chunks;
  for (const char byte : packed) chunks += png_chunk("IDAT", {&byte, 1});
  const auto png = png_of_chunks(kHeader, chunks);
  ASSERT_TRUE(read_fast(png));
  EXPECT_EQ(read_fast(png), read_otherwise(png));
}

TEST(PlainPng, WhatIsNotAsPlainIsLeftToLibpng) {
  const std::string rows = filtered({0, 0, 0, 0, 0});
  const std::string pixels = png_chunk("IDAT", packed_by_zlib(rows));
  const std::string text = png_chunk("tEXt", std::string_view("Title\0a town", 12));
  for (const auto& png : {
           png_of_rows(kHeader, filtered({1, 0, 0, 0, 0})),
           png_of_rows(kHeader, filtered({0, 3, 0, 0, 0})),
           png_of_rows(kHeader, filtered({0, 0, 0, 0, 4})),
           png_of_chunks(kHeader, text + pixels),
           png_of_chunks(kHeader, pixels + text),
           png_of_chunks(kHeader, png_chunk("IDAT", packed_by_zlib(rows, 9))),
       }) {
    EXPECT_FALSE(read_fast(png));
    EXPECT_TRUE(read_otherwise(png));
  }
}

TEST(PlainPng, AnotherShapeIsNotRead) {
  const auto png = encode_plain_png(random_pixels(kShape), kShape);
  for (const PngShape& other : {PngShape{5, 6, 1, 16}, PngShape{12, 5, 1, 8}, PngShape{6, 4, 1, 16}}) {
    EXPECT_FALSE(read_fast(png, other));
  }
  const std::string rows = filtered({0, 0, 0, 0, 0});
  EXPECT_FALSE(read_fast(png_of_rows({6, 5, 16, 0, 1}, rows))) << "interlaced";
  EXPECT_FALSE(read_fast(png_of_rows({6, 5, 8, 4, 0}, rows))) << "8 bits and as many of alpha";
  EXPECT_FALSE(read_fast(png_of_rows({12, 5, 8, 3, 0}, rows), {12, 5, 1, 8})) << "palette";
}

TEST(PlainPng, DamageIsReadByNeitherReader) {
  const std::string rows = filtered({0, 2, 0, 2, 0});
  const std::string packed = packed_by_zlib(rows);
  std::string wrong_sum = packed;
  wrong_sum.back() = static_cast<char>(wrong_sum.back() ^ 1);
  const auto of_stream = [](const std::string& stream) { return png_of_chunks(kHeader, png_chunk("IDAT", stream)); };
  auto longer = png_of_rows(kHeader, rows);
  longer.push_back(std::byte{0});
  const std::string text = png_chunk("tEXt", std::string_view("Title\0a town", 12));
  const std::string parts = png_chunk("IDAT", packed.substr(0, 9)) + text + png_chunk("IDAT", packed.substr(9));
  const std::map<std::string, std::vector<std::byte>> damaged{
      {"checksum of the pixels", of_stream(wrong_sum)},
      {"rows missing", of_stream(packed_by_zlib(rows.substr(kRowBytes + 1)))},
      {"bytes missing", of_stream(packed.substr(0, packed.size() - 5))},
      {"a bomb", of_stream(packed_by_zlib(rows + std::string(1'000'000, '\0')))},
      {"bytes after the pixels", of_stream(packed + "more")},
      {"bytes after the end", longer},
      {"unknown filter", png_of_rows(kHeader, filtered({0, 5, 0, 0, 0}))},
      {"no pixels", png_of_chunks(kHeader, {})},
      {"something between the pixels", png_of_chunks(kHeader, parts)},
  };
  for (const auto& [what, png] : damaged) {
    EXPECT_FALSE(read_fast(png)) << what;
    EXPECT_FALSE(read_otherwise(png)) << what;
  }
}

TEST(PlainPng, EachChangedOrMissingByteIsFound) {
  const auto png = encode_plain_png(random_pixels(kShape), kShape);
  for (std::size_t i = 0; i < png.size(); ++i) {
    EXPECT_FALSE(read_fast(std::span(png).first(i))) << i << " bytes";
    auto damaged = png;
    damaged[i] ^= std::byte{0x10};
    EXPECT_FALSE(read_fast(damaged)) << "byte " << i;
  }
}

}  // namespace
}  // namespace roadfix
