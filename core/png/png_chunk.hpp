// Chunks, of which a PNG is made (W3C PNG 5.3): a type of four letters, data, and a checksum of both.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace roadfix {

/// With which every PNG begins.
inline constexpr std::string_view kPngSignature("\x89PNG\r\n\x1a\n", 8);

struct PngChunk {
  std::string_view type;
  std::string_view data;
  std::uint32_t checksum = 0;  ///< as stored

  bool intact() const;
};

/// Takes the first chunk off `bytes`, what follows the signature of a PNG. nullopt where it is cut off.
std::optional<PngChunk> take_png_chunk(std::string_view& bytes);

/// The bytes of a chunk. `type` has four characters.
std::string png_chunk(std::string_view type, std::string_view data);

/// As PNG has numbers: four bytes, the highest first.
std::string png_number(std::uint32_t number);

}  // namespace roadfix
