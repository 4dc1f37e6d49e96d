#include "core/png/png_chunk.hpp"
#include "core/units/bytes.hpp"

#include <libdeflate.h>

#include <cassert>
#include <cstddef>

namespace roadfix {
namespace {

constexpr std::size_t kNumber = 4;
constexpr std::size_t kType = 4;
constexpr std::size_t kAroundData = kNumber + kType + kNumber;  // length and type before it, checksum behind

std::uint32_t number_at(std::string_view bytes) {
  return static_cast<std::uint32_t>(big_endian(bytes_of(bytes.substr(0, kNumber))));
}

}  // namespace

bool PngChunk::intact() const {
  return libdeflate_crc32(libdeflate_crc32(0, type.data(), type.size()), data.data(), data.size()) == checksum;
}

std::optional<PngChunk> take_png_chunk(std::string_view& bytes) {
  if (bytes.size() < kAroundData || number_at(bytes) > bytes.size() - kAroundData) return {};
  const std::size_t size = number_at(bytes);
  const std::string_view data = bytes.substr(kNumber + kType, size);
  const PngChunk chunk{bytes.substr(kNumber, kType), data, number_at(bytes.substr(kNumber + kType + size))};
  bytes.remove_prefix(kAroundData + size);
  return chunk;
}

std::string png_chunk(std::string_view type, std::string_view data) {
  assert(type.size() == kType);
  std::string bytes = png_number(static_cast<std::uint32_t>(data.size()));
  bytes.reserve(kAroundData + data.size());
  bytes.append(type).append(data);
  return bytes + png_number(libdeflate_crc32(0, &bytes[kNumber], kType + data.size()));
}

std::string png_number(std::uint32_t number) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<char>(number >> shift));
  return bytes;
}

}  // namespace roadfix
