#include "core/png/plain_png.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <string_view>

#include "core/png/png_chunk.hpp"
#include "core/units/bytes.hpp"

namespace roadfix {
namespace {

constexpr std::uint8_t kAsItIs = 0;             // filter types (W3C PNG 9.2)
constexpr std::uint8_t kDifferenceToAbove = 2;  // written by earlier versions

template <auto function>
struct Free {
  template <class T>
  void operator()(T* object) const {
    function(object);
  }
};
using Packer = std::unique_ptr<libdeflate_compressor, Free<libdeflate_free_compressor>>;
using Unpacker = std::unique_ptr<libdeflate_decompressor, Free<libdeflate_free_decompressor>>;

std::size_t row_bytes(const PngShape& shape) { return shape.bytes() / static_cast<std::size_t>(shape.rows); }

/// Data of the chunk IHDR: packed and filtered in the only way there is, not interlaced.
std::string header(const PngShape& shape) {
  constexpr std::array<char, 4> kColourTypes{0, 4, 2, 6};  // by channels: grey, with alpha, RGB, with alpha
  const char colour_type = kColourTypes.at(static_cast<std::size_t>(shape.channels - 1));
  return png_number(static_cast<std::uint32_t>(shape.cols)) + png_number(static_cast<std::uint32_t>(shape.rows)) +
         std::string{static_cast<char>(shape.bits), colour_type, 0, 0, 0};
}

std::string packed(std::string_view bytes) {
  constexpr int kFastest = 1;  // higher levels make tiles of roads no smaller, and those of detections by 2 to 4 %
  const Packer packer(libdeflate_alloc_compressor(kFastest));
  if (!packer) throw std::bad_alloc();
  std::string result(libdeflate_zlib_compress_bound(packer.get(), bytes.size()), '\0');
  result.resize(libdeflate_zlib_compress(packer.get(), bytes.data(), bytes.size(), result.data(), result.size()));
  return result;
}

/// False where `stream` is not of `bytes.size()` bytes, or not all of it is.
bool unpack(std::string_view stream, std::span<std::uint8_t> bytes) {
  constexpr char kWindow = 0x78;  // of 32 KB: libdeflate would not hold a stream to a smaller one
  if (!stream.starts_with(kWindow)) return false;
  const Unpacker unpacker(libdeflate_alloc_decompressor());
  if (!unpacker) throw std::bad_alloc();
  std::size_t used = 0;
  return libdeflate_zlib_decompress_ex(unpacker.get(), stream.data(), stream.size(), bytes.data(), bytes.size(), &used,
                                       nullptr) == LIBDEFLATE_SUCCESS &&
         used == stream.size();
}

std::optional<PngChunk> take_intact(std::string_view& bytes) {
  const auto chunk = take_png_chunk(bytes);
  return chunk && chunk->intact() ? chunk : std::nullopt;
}

/// The packed pixels, unless there is anything beside them.
std::optional<std::string> stream_in(std::string_view png, const PngShape& shape) {
  if (!png.starts_with(kPngSignature)) return {};
  png.remove_prefix(kPngSignature.size());
  auto chunk = take_intact(png);
  if (!chunk || chunk->type != "IHDR" || chunk->data != header(shape)) return {};
  std::string stream;
  for (chunk = take_intact(png); chunk && chunk->type == "IDAT"; chunk = take_intact(png)) stream += chunk->data;
  if (!chunk || chunk->type != "IEND" || !chunk->data.empty() || !png.empty()) return {};
  return stream;
}

/// `rows`: each of them after its filter type.
bool unfilter(std::span<const std::uint8_t> rows, std::size_t row_bytes, std::span<std::uint8_t> pixels) {
  const std::vector<std::uint8_t> above_all(row_bytes);
  std::span<const std::uint8_t> above(above_all);
  for (std::size_t at = 0; at < rows.size(); at += 1 + row_bytes) {
    const auto from = rows.subspan(at + 1, row_bytes);
    const auto to = pixels.subspan(at / (1 + row_bytes) * row_bytes, row_bytes);
    if (rows[at] == kAsItIs) {
      std::ranges::copy(from, to.begin());
    } else if (rows[at] == kDifferenceToAbove) {
      std::ranges::transform(from, above, to.begin(),
                             [](int difference, int pixel) { return static_cast<std::uint8_t>(difference + pixel); });
    } else {
      return false;
    }
    above = to;
  }
  return true;
}

}  // namespace

std::vector<std::byte> encode_plain_png(std::span<const std::uint8_t> pixels, const PngShape& shape) {
  assert(pixels.size() == shape.bytes());
  std::string rows;
  rows.reserve(pixels.size() + static_cast<std::size_t>(shape.rows));
  for (std::size_t at = 0; at < pixels.size(); at += row_bytes(shape)) {
    rows.push_back(static_cast<char>(kAsItIs));
    rows.append(characters_of(pixels.subspan(at, row_bytes(shape))));
  }
  const std::string png = std::string(kPngSignature) + png_chunk("IHDR", header(shape)) +
                          png_chunk("IDAT", packed(rows)) + png_chunk("IEND", {});
  const auto bytes = std::as_bytes(std::span(png));
  return {bytes.begin(), bytes.end()};
}

bool read_plain_png(std::span<const std::byte> png, const PngShape& shape, std::span<std::uint8_t> pixels) {
  assert(shape.channels == 1 && pixels.size() == shape.bytes());
  const auto stream = stream_in({reinterpret_cast<const char*>(png.data()), png.size()}, shape);
  std::vector<std::uint8_t> rows(pixels.size() + static_cast<std::size_t>(shape.rows));
  return stream && unpack(*stream, rows) && unfilter(rows, row_bytes(shape), pixels);
}

}  // namespace roadfix
