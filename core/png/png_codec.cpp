#include "core/png/png_codec.hpp"

#include <png.h>
#include <zlib.h>

#include <array>
#include <bit>
#include <cassert>
#include <csetjmp>
#include <cstring>
#include <utility>

#include "core/units/error.hpp"

namespace roadfix {
namespace {

// Whatever lives across a longjmp is owned by a State or a Writer, outside the frame that is left.

using Message = std::array<char, 128>;

[[noreturn]] void on_error(png_structp png, png_const_charp text) {
  auto& message = *static_cast<Message*>(png_get_error_ptr(png));
  std::strncpy(message.data(), text, message.size() - 1);
  std::longjmp(png_jmpbuf(png), 1);
}

/// Damage to a checksum beside the pixels, for one, is only a warning to libpng.
void on_warning_in_own(png_structp png, png_const_charp text) { on_error(png, text); }

void on_warning(png_structp, png_const_charp) {}

void on_read(png_structp png, png_bytep target, std::size_t size) {
  auto& rest = *static_cast<std::span<const std::byte>*>(png_get_io_ptr(png));
  if (size > rest.size()) png_error(png, "cut off");
  std::memcpy(target, rest.data(), size);
  rest = rest.subspan(size);
}

void on_write(png_structp png, png_bytep data, std::size_t size) {
  auto& output = *static_cast<std::vector<std::byte>*>(png_get_io_ptr(png));
  const auto* first = reinterpret_cast<const std::byte*>(data);
  output.insert(output.end(), first, first + size);
}

void require_own(png_structp png, png_infop info) {
  if (png_get_color_type(png, info) != PNG_COLOR_TYPE_GRAY || png_get_bit_depth(png, info) < 8 ||
      png_get_interlace_type(png, info) != PNG_INTERLACE_NONE) {
    png_error(png, "not a plain grey image of 8 or 16 bits");
  }
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

struct Writer {
  Writer() = default;
  ~Writer() { png_destroy_write_struct(&png, &info); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  png_structp png = nullptr;
  png_infop info = nullptr;
  Message message{};
  std::vector<std::byte> output;
};

/// False: writer.message says why. No object with a destructor may live in this frame.
bool write(Writer& writer, std::span<const std::uint8_t> pixels, const PngShape& shape, PngFilter filter) {
  if (setjmp(png_jmpbuf(writer.png)) != 0) return false;
  png_set_write_fn(writer.png, &writer.output, on_write, nullptr);
  png_set_IHDR(writer.png, writer.info, static_cast<png_uint_32>(shape.cols), static_cast<png_uint_32>(shape.rows),
               shape.bits, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_set_compression_strategy(writer.png, Z_RLE);
  png_set_filter(writer.png, PNG_FILTER_TYPE_BASE, filter == PngFilter::kNone ? PNG_FILTER_NONE : PNG_FILTER_UP);
  png_write_info(writer.png, writer.info);
  const std::size_t row_bytes = pixels.size() / static_cast<std::size_t>(shape.rows);
  for (std::size_t at = 0; at < pixels.size(); at += row_bytes) png_write_row(writer.png, &pixels[at]);
  png_write_end(writer.png, nullptr);
  return true;
}

}  // namespace

std::size_t PngShape::bytes() const {
  return static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols) *
         static_cast<std::size_t>(channels * bits / 8);
}

struct PngReader::State {
  State(std::span<const std::byte> bytes, PngOrigin made_by) : rest(bytes), origin(made_by) {}
  ~State() { png_destroy_read_struct(&png, &info, nullptr); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  /// False: `message` says why. No object with a destructor may live in these two frames.
  bool begin();
  bool finish();
  CorruptData damage() const { return {"png-damaged", message.data()}; }

  std::span<const std::byte> rest;
  PngOrigin origin;
  png_structp png = nullptr;
  png_infop info = nullptr;
  Message message{};
  PngShape shape;
  std::vector<png_bytep> rows;
};

bool PngReader::State::begin() {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_read_fn(png, &rest, on_read);
  png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
  if (origin == PngOrigin::kOwn) png_set_crc_action(png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
  png_read_info(png, info);
  if (origin == PngOrigin::kOwn) {
    require_own(png, info);
  } else {
    choose_channels(png, info);
  }
  shape = {static_cast<int>(png_get_image_width(png, info)), static_cast<int>(png_get_image_height(png, info)),
           png_get_channels(png, info), png_get_bit_depth(png, info)};
  return true;
}

bool PngReader::State::finish() {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_read_image(png, rows.data());
  png_read_end(png, nullptr);
  if (origin == PngOrigin::kOwn && !rest.empty()) png_error(png, "bytes after the end of the image");
  return true;
}

PngReader::PngReader(std::span<const std::byte> png, PngOrigin origin) : state_(std::make_unique<State>(png, origin)) {
  State& state = *state_;
  state.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &state.message, on_error,
                                     origin == PngOrigin::kOwn ? on_warning_in_own : on_warning);
  if (state.png != nullptr) state.info = png_create_info_struct(state.png);
  if (state.info == nullptr || !state.begin()) throw state.damage();
}

PngReader::~PngReader() = default;

const PngShape& PngReader::shape() const { return state_->shape; }

void PngReader::read(std::span<std::uint8_t> pixels) {
  assert(pixels.size() == shape().bytes());
  const auto rows = static_cast<std::size_t>(shape().rows);
  for (std::size_t row = 0; row < rows; ++row) state_->rows.push_back(&pixels[row * (pixels.size() / rows)]);
  if (!state_->finish()) throw state_->damage();
}

std::vector<std::byte> encode_grey_png(std::span<const std::uint8_t> pixels, const PngShape& shape, PngFilter filter) {
  assert(shape.channels == 1 && pixels.size() == shape.bytes());
  Writer writer;
  writer.output.reserve(pixels.size() + pixels.size() / 8);  // no allocation may fail below libpng
  writer.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &writer.message, on_error, on_warning_in_own);
  if (writer.png != nullptr) writer.info = png_create_info_struct(writer.png);
  if (writer.info == nullptr || !write(writer, pixels, shape, filter)) {
    throw IoFailure("png-not-encoded", writer.message.data());
  }
  return std::move(writer.output);
}

}  // namespace roadfix
