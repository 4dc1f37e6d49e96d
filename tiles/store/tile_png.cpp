#include "tiles/store/tile_png.hpp"

#include <fmt/format.h>
#include <png.h>
#include <zlib.h>

#include <array>
#include <cassert>
#include <csetjmp>
#include <cstdint>
#include <cstring>
#include <utility>

#include "core/units/error.hpp"
#include "tiles/store/map_records.hpp"

namespace roadfix {
namespace {

constexpr std::size_t kCells = std::size_t{kTileCells} * kTileCells;
constexpr std::uint16_t kNull16 = 0xffff;
/// Bounds on chunks that a tile does not need and libpng would unpack (texts, colour profiles).
constexpr std::size_t kLargestChunk = 1 << 16;
constexpr std::uint32_t kChunksKept = 8;

/// What libpng's callbacks need. Everything that lives across a longjmp is owned here, outside the frame that jumps.
struct Codec {
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::array<char, 128> message{};
  std::span<const std::byte> input;
  std::size_t consumed = 0;
  std::vector<std::byte> output;
  std::vector<std::uint8_t> pixels;
  std::array<png_bytep, kTileCells> rows{};

  explicit Codec(int bits) : pixels(kCells * static_cast<std::size_t>(bits / 8)) {
    for (std::size_t r = 0; r < rows.size(); ++r) rows[r] = &pixels[r * pixels.size() / rows.size()];
  }
};

[[noreturn]] void on_error(png_structp png, png_const_charp message) {
  auto& codec = *static_cast<Codec*>(png_get_error_ptr(png));
  std::strncpy(codec.message.data(), message, codec.message.size() - 1);
  std::longjmp(png_jmpbuf(png), 1);
}

/// Damage to a checksum is only a warning to libpng; a stored tile with one is damaged.
void on_warning(png_structp png, png_const_charp message) { on_error(png, message); }

void on_read(png_structp png, png_bytep target, std::size_t size) {
  auto& codec = *static_cast<Codec*>(png_get_io_ptr(png));
  if (size > codec.input.size() - codec.consumed) png_error(png, "cut off");
  std::memcpy(target, codec.input.data() + codec.consumed, size);
  codec.consumed += size;
}

void on_write(png_structp png, png_bytep data, std::size_t size) {
  auto& output = static_cast<Codec*>(png_get_io_ptr(png))->output;
  const auto* first = reinterpret_cast<const std::byte*>(data);
  output.insert(output.end(), first, first + size);
}

/// False: codec.message says why. No object with a destructor may live in this frame.
bool read_png(Codec& codec, int bits) {
  if (setjmp(png_jmpbuf(codec.png)) != 0) return false;
  png_set_read_fn(codec.png, &codec, on_read);
  png_set_crc_action(codec.png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
  png_set_user_limits(codec.png, kTileCells, kTileCells);
  png_set_chunk_malloc_max(codec.png, kLargestChunk);
  png_set_chunk_cache_max(codec.png, kChunksKept);
  png_read_info(codec.png, codec.info);
  if (png_get_image_width(codec.png, codec.info) != png_uint_32{kTileCells} ||
      png_get_image_height(codec.png, codec.info) != png_uint_32{kTileCells} ||
      png_get_color_type(codec.png, codec.info) != PNG_COLOR_TYPE_GRAY ||
      png_get_bit_depth(codec.png, codec.info) != bits ||
      png_get_interlace_type(codec.png, codec.info) != PNG_INTERLACE_NONE) {
    png_error(codec.png, "not a grey image of 256 x 256 pixels of the expected depth");
  }
  png_read_image(codec.png, codec.rows.data());
  png_read_end(codec.png, nullptr);
  if (codec.consumed != codec.input.size()) png_error(codec.png, "bytes after the end of the image");
  return true;
}

bool write_png(Codec& codec, int bits, int filter) {
  if (setjmp(png_jmpbuf(codec.png)) != 0) return false;
  png_set_write_fn(codec.png, &codec, on_write, nullptr);
  png_set_IHDR(codec.png, codec.info, kTileCells, kTileCells, bits, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_compression_strategy(codec.png, Z_RLE);
  png_set_filter(codec.png, PNG_FILTER_TYPE_BASE, filter);
  png_write_info(codec.png, codec.info);
  png_write_image(codec.png, codec.rows.data());
  png_write_end(codec.png, nullptr);
  return true;
}

void unpack(const std::vector<std::uint8_t>& pixels, std::span<Cell> cells) {
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto value = static_cast<std::uint16_t>(pixels[2 * i] << 8 | pixels[2 * i + 1]);
    if (value > kRoad && value != kNull16) {
      throw CorruptData("tile-corrupt", fmt::format("value {} is neither 0..254 nor unobserved", value));
    }
    cells[i] = static_cast<Cell>(value == kNull16 ? kUnobserved : value);
  }
}

void pack(std::span<const Cell> cells, std::vector<std::uint8_t>& pixels) {
  for (std::size_t i = 0; i < cells.size(); ++i) {
    pixels[2 * i] = is_observed(cells[i]) ? 0 : 0xff;
    pixels[2 * i + 1] = cells[i];
  }
}

std::vector<std::byte> encoded(const CellArray& cells, TileDepth depth, int filter) {
  const int bits = static_cast<int>(depth);
  Codec codec(bits);
  if (depth == TileDepth::kFused) {
    pack(cells.cells(), codec.pixels);
  } else {
    std::memcpy(codec.pixels.data(), cells.cells().data(), kCells);
  }
  codec.output.reserve(codec.pixels.size() + codec.pixels.size() / 8);  // no allocation may fail below libpng
  codec.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &codec, on_error, on_warning);
  codec.info = codec.png == nullptr ? nullptr : png_create_info_struct(codec.png);
  const bool written = codec.info != nullptr && write_png(codec, bits, filter);
  png_destroy_write_struct(&codec.png, &codec.info);
  if (!written) throw IoFailure("tile-not-encoded", fmt::format("libpng: {}", codec.message.data()));
  return std::move(codec.output);
}

}  // namespace

std::vector<std::byte> encode_tile(const CellArray& cells, TileDepth depth) {
  assert(cells.cols() == kTileCells && cells.rows() == kTileCells);
  // Runs are what a road map has. Matching only these takes a tenth of the time of the default strategy, and detections
  // (noise) need less room. Drawn roads need less with differences between rows: try both, which is still faster.
  auto plain = encoded(cells, depth, PNG_FILTER_NONE);
  auto differences = encoded(cells, depth, PNG_FILTER_UP);
  return plain.size() <= differences.size() ? plain : differences;
}

CellArray decode_tile(std::span<const std::byte> png, TileDepth depth) {
  const int bits = static_cast<int>(depth);
  Codec codec(bits);
  codec.input = png;
  codec.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &codec, on_error, on_warning);
  codec.info = codec.png == nullptr ? nullptr : png_create_info_struct(codec.png);
  const bool read = codec.info != nullptr && read_png(codec, bits);
  png_destroy_read_struct(&codec.png, &codec.info, nullptr);
  if (!read) throw CorruptData("tile-corrupt", fmt::format("PNG decoder: {}", codec.message.data()));
  CellArray cells(kTileCells, kTileCells);
  if (depth == TileDepth::kFused) {
    unpack(codec.pixels, cells.cells());
  } else {
    std::memcpy(cells.cells().data(), codec.pixels.data(), kCells);
  }
  return cells;
}

}  // namespace roadfix
