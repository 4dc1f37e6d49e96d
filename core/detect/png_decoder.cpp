#include "core/detect/png_decoder.hpp"

#include <fmt/format.h>
#include <png.h>

#include <array>
#include <bit>
#include <csetjmp>
#include <cstring>
#include <vector>

#include "core/units/error.hpp"

namespace roadfix {
namespace {

/// What libpng's callbacks need. Everything that lives across a longjmp is owned here, outside the frame that jumps.
struct Reader {
  explicit Reader(std::span<const std::uint8_t> bytes) : rest(bytes) {}
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  std::span<const std::uint8_t> rest;
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::array<char, 128> message{};
  cv::Mat pixels;
  std::vector<png_bytep> rows;
};

[[noreturn]] void on_error(png_structp png, png_const_charp message) {
  auto& reader = *static_cast<Reader*>(png_get_error_ptr(png));
  std::strncpy(reader.message.data(), message, reader.message.size() - 1);
  std::longjmp(png_jmpbuf(png), 1);
}

/// Of parts that are not needed for the pixels.
void on_warning(png_structp, png_const_charp) {}

void on_read(png_structp png, png_bytep target, std::size_t size) {
  auto& reader = *static_cast<Reader*>(png_get_io_ptr(png));
  if (size > reader.rest.size()) png_error(png, "cut off");
  std::memcpy(target, reader.rest.data(), size);
  reader.rest = reader.rest.subspan(size);
}

/// Asks libpng for channels and bits as OpenCV keeps them.
void choose_channels(png_structp png, png_infop info) {
  const bool alpha = (png_get_color_type(png, info) & PNG_COLOR_MASK_ALPHA) != 0;
  png_set_expand(png);
  if (alpha || png_get_valid(png, info, PNG_INFO_tRNS) != 0) png_set_gray_to_rgb(png);
  png_set_bgr(png);
  if constexpr (std::endian::native == std::endian::little) png_set_swap(png);
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
}

void make_room(Reader& reader) {
  const int depth = png_get_bit_depth(reader.png, reader.info) == 16 ? CV_16U : CV_8U;
  const int channels = png_get_channels(reader.png, reader.info);
  reader.pixels.create(static_cast<int>(png_get_image_height(reader.png, reader.info)),
                       static_cast<int>(png_get_image_width(reader.png, reader.info)), CV_MAKETYPE(depth, channels));
  for (int row = 0; row < reader.pixels.rows; ++row) reader.rows.push_back(reader.pixels.ptr(row));
}

/// False: reader.message says why. No object with a destructor may live in this frame.
bool read(Reader& reader) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  png_set_read_fn(reader.png, &reader, on_read);
  png_set_keep_unknown_chunks(reader.png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);  // texts, colour profiles: see header
  png_read_info(reader.png, reader.info);
  choose_channels(reader.png, reader.info);
  make_room(reader);
  png_read_image(reader.png, reader.rows.data());
  png_read_end(reader.png, nullptr);
  return true;
}

}  // namespace

cv::Mat decode_png(std::span<const std::uint8_t> bytes) {
  Reader reader(bytes);
  reader.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reader, on_error, on_warning);
  if (reader.png != nullptr) reader.info = png_create_info_struct(reader.png);
  if (reader.info == nullptr || !read(reader)) {
    throw InvalidInput("image-damaged", fmt::format("the PNG image is damaged or cut off ({})", reader.message.data()));
  }
  return reader.pixels;
}

}  // namespace roadfix
