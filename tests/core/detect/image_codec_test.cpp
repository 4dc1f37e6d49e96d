#include "core/detect/image_codec.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stop_token>
#include <string>
#include <vector>

#include "core/detect/frame_image.hpp"
#include "core/png/png_chunk.hpp"
#include "core/units/error.hpp"
#include "tests/support/code_of.hpp"
#include "tests/support/encoded.hpp"
#include "tests/support/peak_memory.hpp"

namespace roadfix {
namespace {

using testing::code_of;
using testing::encoded;

constexpr std::int64_t kMany = 1'000'000;

TEST(FrameCodec, PicturesComeBackAsTheyWereWithWhatWasNotSeen) {
  for (const int type : {CV_8UC1, CV_8UC3}) {
    FramePixels frame{cv::Mat(40, 31, type), cv::Mat(40, 31, CV_8UC1, cv::Scalar(255))};
    cv::RNG(3).fill(frame.pixels, cv::RNG::UNIFORM, 0, 256);
    const auto back = [&] { return frame_image(decode_image(encode_frame(frame), kMany)); };
    EXPECT_EQ(cv::norm(back().pixels, frame.pixels, cv::NORM_INF), 0.0);
    EXPECT_EQ(cv::norm(back().observed, frame.observed, cv::NORM_INF), 0.0);
    frame.observed(cv::Rect(5, 0, 7, 40)) = 0;
    EXPECT_EQ(cv::norm(back().observed, frame.observed, cv::NORM_INF), 0.0);
    cv::Mat colour = frame.pixels;
    if (type == CV_8UC1) cv::cvtColor(frame.pixels, colour, cv::COLOR_GRAY2BGR);
    EXPECT_EQ(cv::norm(back().pixels, colour, cv::NORM_INF), 0.0) << "also below what was not seen";
  }
}

TEST(ImageHeader, TellsTheSizeOfPngAndJpeg) {
  const cv::Mat image(30, 47, CV_8UC3, cv::Scalar(1, 2, 3));
  for (const char* extension : {".png", ".jpg"}) {
    const auto header = read_image_header(encoded(extension, image));
    ASSERT_TRUE(header) << extension;
    EXPECT_EQ(header->cols, 47);
    EXPECT_EQ(header->rows, 30);
  }
}

TEST(DecodeImage, RefusesABombByItsHeader) {
  auto png = encoded(".png", cv::Mat(2, 2, CV_8UC1, cv::Scalar(0)));
  png[16] = 0x7f;  // 2 billion columns
  EXPECT_EQ(code_of([&] { decode_image(png, kMany); }), "image-too-large");
  EXPECT_EQ(code_of([&] { decode_image(encoded(".png", cv::Mat(100, 100, CV_8UC1)), 9'999); }), "image-too-large");
}

std::string refusal_of(Bytes picture) {
  try {
    decode_image(picture, kMany);
    return "none";
  } catch (const InvalidInput& error) {
    return error.what();
  }
}

/// libpng passes over a text before the header, of which the first bytes look like the size of 2 x 2 pixels.
TEST(DecodeImage, RefusesAPngBombBehindAnotherSizeBeforeItMakesRoom) {
  const std::string size = png_number(30'000) + png_number(30'000);
  const std::string png = std::string(kPngSignature) + png_chunk("tEXt", png_number(2) + png_number(2) + "name") +
                          png_chunk("IHDR", size + std::string{8, 0, 0, 0, 0}) + png_chunk("IDAT", {});
  ASSERT_EQ(read_image_header(bytes_of(png))->cols, 2);
  EXPECT_THAT(refusal_of(bytes_of(png)), ::testing::HasSubstr("two sizes"));
}

/// To libjpeg the marker TEM has no length. With one it leads to where two comments look like a header.
TEST(DecodeImage, RefusesAJpegBombBehindAnotherSizeBeforeItMakesRoom) {
  std::vector<std::uint8_t> jpeg{0xff, 0xd8, 0xff, 0x01, 0xff, 0xfe, 0xff, 0xff};
  const auto append = [&jpeg](std::initializer_list<std::uint8_t> bytes) { jpeg.insert(jpeg.end(), bytes); };
  jpeg.resize(4 + 0xfffe);
  append({0xff, 0xc0, 0, 0xff, 0xfe, 0, 16, 0, 16});
  jpeg.resize(jpeg.size() + 12);
  append({0xff, 0xc0, 0, 11, 8, 0x75, 0x30, 0x75, 0x30, 1, 1, 0x11, 0, 0xff, 0xda, 0, 8, 1, 1, 0, 0, 63, 0});
  ASSERT_EQ(read_image_header(jpeg)->cols, 16);
  EXPECT_THAT(refusal_of(jpeg), ::testing::HasSubstr("two sizes"));
}

TEST(DecodeImage, RefusesWhatIsNoImageAndWhatIsDamaged) {
  const std::vector<std::uint8_t> text{'h', 'e', 'l', 'l', 'o'};
  EXPECT_EQ(code_of([&] { decode_image(text, kMany); }), "image-format");
  EXPECT_EQ(code_of([&] { decode_image({}, kMany); }), "image-format");
  auto png = encoded(".png", cv::Mat(64, 64, CV_8UC3, cv::Scalar(9, 99, 199)));
  png.resize(40);
  EXPECT_EQ(code_of([&] { decode_image(png, kMany); }), "image-damaged");
}

TEST(DecodeImage, RefusesAJpegThatWasCutOffAnywhere) {
  cv::Mat noise(64, 64, CV_8UC3);
  cv::RNG(1).fill(noise, cv::RNG::UNIFORM, 0, 256);
  const auto jpeg = encoded(".jpg", noise);
  EXPECT_EQ(code_of([&] { decode_image(jpeg, kMany); }), "no error");
  for (std::size_t size = 4; size < jpeg.size(); size += 97) {
    EXPECT_NE(code_of([&] { decode_image(Bytes(jpeg).first(size), kMany); }), "no error") << size;
  }
}

TEST(DecodeImage, RefusesAPngWithAnyByteOfItsPixelsChanged) {
  cv::Mat noise(64, 64, CV_8UC3);
  cv::RNG(1).fill(noise, cv::RNG::UNIFORM, 0, 256);
  const auto png = encoded(".png", noise);
  for (std::size_t at = 60; at + 20 < png.size(); at += 997) {
    auto damaged = png;
    damaged[at] ^= 0x55;
    EXPECT_EQ(code_of([&] { decode_image(damaged, kMany); }), "image-damaged") << at;
  }
}

TEST(DecodeImage, RefusesAJpegThatEndsBeforeItsPixelsDo) {
  cv::Mat noise(64, 64, CV_8UC3);
  cv::RNG(1).fill(noise, cv::RNG::UNIFORM, 0, 256);
  auto jpeg = encoded(".jpg", noise);
  jpeg[jpeg.size() / 2] = 0xff;
  jpeg[jpeg.size() / 2 + 1] = 0xd9;
  EXPECT_EQ(code_of([&] { decode_image(jpeg, kMany); }), "image-damaged");
}

TEST(DecodeImage, TakesAJpegWithBytesToNoPurposeBeforeItsEnd) {
  cv::Mat noise(64, 64, CV_8UC1);
  cv::RNG(1).fill(noise, cv::RNG::UNIFORM, 0, 256);
  const auto jpeg = encoded(".jpg", noise);
  auto padded = jpeg;
  padded.insert(padded.end() - 2, 7, 0);
  EXPECT_EQ(cv::norm(decode_image(padded, kMany), decode_image(jpeg, kMany), cv::NORM_INF), 0.0);
}

TEST(DecodeImage, TakesAJpegOfAnUnknownVersionOfJfif) {
  const auto jpeg = encoded(".jpg", cv::Mat(16, 16, CV_8UC1, cv::Scalar(90)));
  constexpr std::size_t kMajorVersion = 11;
  auto other = jpeg;
  ASSERT_EQ(other[kMajorVersion], 1);
  other[kMajorVersion] = 3;
  EXPECT_EQ(cv::norm(decode_image(other, kMany), decode_image(jpeg, kMany), cv::NORM_INF), 0.0);
}

/// Grey and progressive: one block of 8 x 8 pixels, in so many scans more than its first, each of which says nothing.
std::vector<std::uint8_t> jpeg_of_scans(int more) {
  std::vector<std::uint8_t> jpeg{0xff, 0xd8, 0xff, 0xdb, 0, 67, 0};
  jpeg.insert(jpeg.end(), 64, 16);
  const auto append = [&jpeg](std::initializer_list<std::uint8_t> bytes) { jpeg.insert(jpeg.end(), bytes); };
  append({0xff, 0xc2, 0, 11, 8, 0, 8, 0, 8, 1, 1, 0x11, 0});
  for (const std::uint8_t table :
       std::array<std::uint8_t, 2>{0x00, 0x10}) {  // one code of one bit: no bits of a difference, an end of the block
    append({0xff, 0xc4, 0, 20, table, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  }
  append({0xff, 0xda, 0, 8, 1, 1, 0, 0, 0, 0, 0x7f});
  for (int i = 0; i < more; ++i) append({0xff, 0xda, 0, 8, 1, 1, 0, 1, 63, 0, 0x7f});
  append({0xff, 0xd9});
  return jpeg;
}

TEST(DecodeImage, RefusesAJpegOfMoreScansThanAnyEncoderWrites) {
  EXPECT_EQ(code_of([] { decode_image(jpeg_of_scans(99), kMany); }), "no error");
  try {
    decode_image(jpeg_of_scans(101), kMany);
    ADD_FAILURE() << "was decoded";
  } catch (const InvalidInput& error) {
    EXPECT_EQ(error.code(), "image-damaged");
    EXPECT_THAT(error.what(), ::testing::HasSubstr("more than 100 scans"));
  }
}

TEST(DecodeImage, EndsWhenAStopIsRequested) {
  std::stop_source stop;
  stop.request_stop();
  const auto jpeg = encoded(".jpg", cv::Mat(16, 16, CV_8UC1, cv::Scalar(90)));
  EXPECT_EQ(code_of([&] { decode_image(jpeg, kMany, stop.get_token()); }), "detection-interrupted");
}

/// A zTXt chunk (W3C PNG 11.3.3.3) of so many spaces.
std::vector<std::uint8_t> text_chunk(std::size_t characters) {
  const std::vector<std::uint8_t> spaces(characters, ' ');
  constexpr std::array<std::uint8_t, 11> kHead{0, 0, 0, 0, 'z', 'T', 'X', 't', 'a', 0, 0};
  constexpr std::size_t kChecksum = 4;
  uLongf packed = compressBound(characters);
  std::vector<std::uint8_t> chunk(kHead.size() + packed + kChecksum);
  std::ranges::copy(kHead, chunk.begin());
  EXPECT_EQ(compress(&chunk[kHead.size()], &packed, spaces.data(), characters), Z_OK);
  chunk.resize(kHead.size() + packed + kChecksum);
  const auto put = [](std::uint8_t* at, std::size_t number) {
    for (int i = 0; i < 4; ++i) at[i] = static_cast<std::uint8_t>(number >> (24 - 8 * i));
  };
  put(chunk.data(), chunk.size() - kChecksum - 8);
  put(&chunk[chunk.size() - kChecksum], crc32(0, &chunk[4], static_cast<uInt>(chunk.size() - kChecksum - 4)));
  return chunk;
}

TEST(DecodeImage, TextsBesideThePixelsOfAPngCostNoMemory) {
  const auto png = encoded(".png", cv::Mat(16, 16, CV_8UC1, cv::Scalar(90)));
  const auto text = text_chunk(7'000'000);
  constexpr int kTexts = 60;
  constexpr std::ptrdiff_t kHeaderEnd = 33;
  auto padded = png;
  for (int i = 0; i < kTexts; ++i) padded.insert(padded.begin() + kHeaderEnd, text.begin(), text.end());
  const long before = testing::peak_memory_kib();
  EXPECT_EQ(cv::norm(decode_image(padded, kMany), decode_image(png, kMany), cv::NORM_INF), 0.0);
  EXPECT_LT(testing::peak_memory_kib() - before, 50'000);
}

TEST(DecodeImage, PrintsNothingWhateverItIsGiven) {
  cv::Mat noise(64, 64, CV_8UC3);
  cv::RNG(1).fill(noise, cv::RNG::UNIFORM, 0, 256);
  ::testing::internal::CaptureStderr();
  for (const char* extension : {".png", ".jpg"}) {
    const auto bytes = encoded(extension, noise);
    for (std::size_t at = 30; at < bytes.size(); at += 211) {
      auto damaged = bytes;
      damaged[at] ^= 0x55;
      code_of([&] { decode_image(damaged, kMany); });
      code_of([&] { decode_image(Bytes(bytes).first(at), kMany); });
    }
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(DecodeImage, GivesThePixelsThatOpenCvGives) {
  for (const int type : {CV_8UC1, CV_8UC3, CV_8UC4, CV_16UC1, CV_16UC3, CV_16UC4}) {
    cv::Mat noise(37, 50, type);
    cv::RNG(1).fill(noise, cv::RNG::UNIFORM, 0, 1 << 16);
    EXPECT_EQ(cv::norm(decode_image(encoded(".png", noise), kMany), noise, cv::NORM_INF), 0.0) << type;
    if (type != CV_8UC1 && type != CV_8UC3) continue;
    const auto jpeg = encoded(".jpg", noise);
    EXPECT_EQ(cv::norm(decode_image(jpeg, kMany), cv::imdecode(jpeg, cv::IMREAD_UNCHANGED), cv::NORM_INF), 0.0) << type;
  }
}

TEST(DecodeImage, LooksUpPalettesAndCountsTheGreyThatStandsForNothingAsUnseen) {
  // 2 x 1 pixels of one bit, 0 and 1: of the palette red and green, and of a grey picture whose black is transparent.
  const std::vector<std::uint8_t> palette{
      0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00,
      0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x01, 0x01, 0x03, 0x00, 0x00, 0x00, 0xce, 0xec, 0xed, 0xc9, 0x00,
      0x00, 0x00, 0x06, 0x50, 0x4c, 0x54, 0x45, 0xff, 0x00, 0x00, 0x00, 0xff, 0x00, 0xd2, 0x87, 0xef, 0x71,
      0x00, 0x00, 0x00, 0x0a, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0x70, 0x00, 0x00, 0x00, 0x42, 0x00,
      0x41, 0x29, 0x37, 0xf4, 0xef, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
  const std::vector<std::uint8_t> grey{
      0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00,
      0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x01, 0x01, 0x00, 0x00, 0x00, 0x00, 0xdc, 0x59, 0x42, 0x27, 0x00,
      0x00, 0x00, 0x02, 0x74, 0x52, 0x4e, 0x53, 0x00, 0x00, 0x76, 0x93, 0xcd, 0x38, 0x00, 0x00, 0x00, 0x0a,
      0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0x70, 0x00, 0x00, 0x00, 0x42, 0x00, 0x41, 0x29, 0x37, 0xf4,
      0xef, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
  const cv::Mat colours = decode_image(palette, kMany);
  EXPECT_EQ(colours.at<cv::Vec3b>(0, 0), cv::Vec3b(0, 0, 255));
  EXPECT_EQ(colours.at<cv::Vec3b>(0, 1), cv::Vec3b(0, 255, 0));
  const FramePixels picture = frame_image(decode_image(grey, kMany));
  EXPECT_EQ(picture.observed.at<uchar>(0, 0), 0);
  EXPECT_EQ(picture.observed.at<uchar>(0, 1), 255);
}

}  // namespace
}  // namespace roadfix
