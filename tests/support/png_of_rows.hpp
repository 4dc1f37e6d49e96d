// PNG as other programs may make it: packed by zlib, rows filtered in any way, and in any number of chunks.
#pragma once

#include <zlib.h>

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/png/png_chunk.hpp"

namespace roadfix::testing {

/// zlib's default; `window_bits` as in zlib.h.
inline std::string packed_by_zlib(std::string_view bytes, int window_bits = MAX_WBITS) {
  z_stream stream{};
  deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, window_bits, 8, Z_DEFAULT_STRATEGY);
  std::string packed(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));  // zlib only reads
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

struct PngHeader {
  std::uint32_t cols = 0;
  std::uint32_t rows = 0;
  char bits = 8;
  char colour_type = 0;
  char interlaced = 0;
};

/// `chunks` are all between the header and the end.
inline std::vector<std::byte> png_of_chunks(const PngHeader& header, std::string_view chunks) {
  const std::string ihdr = png_number(header.cols) + png_number(header.rows) +
                           std::string{header.bits, header.colour_type, 0, 0, header.interlaced};
  const std::string png =
      std::string(kPngSignature) + png_chunk("IHDR", ihdr) + std::string(chunks) + png_chunk("IEND", {});
  const auto bytes = std::as_bytes(std::span(png));
  return {bytes.begin(), bytes.end()};
}

/// `rows`: each of them after its filter type.
inline std::vector<std::byte> png_of_rows(const PngHeader& header, std::string_view rows) {
  return png_of_chunks(header, png_chunk("IDAT", packed_by_zlib(rows)));
}

}  // namespace roadfix::testing
