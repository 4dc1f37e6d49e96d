#include "core/png/png_reader.hpp"

#include <png.h>

#include <array>
#include <bit>
#include <cassert>
#include <csetjmp>
#include <cstring>

#include "core/units/error.hpp"

namespace roadfix {
namespace {

// Whatever lives across a longjmp is owned by a State, outside the frame that is left.

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

}  // namespace roadfix
