#include "core/png/png_text.hpp"

#include <cassert>

#include "core/png/png_chunk.hpp"
#include "core/units/bytes.hpp"

namespace roadfix {
namespace {

constexpr std::size_t kHeaderEnd = 33;  // signature and chunk IHDR

std::vector<std::uint8_t> with_chunk(std::span<const std::uint8_t> png, std::string_view type, std::string_view keyword,
                                     std::string_view between, std::string_view text) {
  assert(png.size() > kHeaderEnd && !keyword.empty() && keyword.size() < 80);
  std::string data(keyword);
  data.append(between).append(text);
  const std::string chunk = png_chunk(type, data);
  std::vector<std::uint8_t> result(png.begin(), png.end());
  result.insert(result.begin() + kHeaderEnd, chunk.begin(), chunk.end());
  return result;
}

}  // namespace

bool is_png(std::span<const std::uint8_t> bytes) { return characters_of(bytes).starts_with(kPngSignature); }

std::vector<std::uint8_t> with_text(std::span<const std::uint8_t> png, std::string_view keyword,
                                    std::string_view text) {
  return with_chunk(png, "tEXt", keyword, {"\0", 1}, text);
}

std::vector<std::uint8_t> with_utf8_text(std::span<const std::uint8_t> png, std::string_view keyword,
                                         std::string_view text) {
  constexpr std::string_view kPlain("\0\0\0\0\0", 5);  // end of the keyword, not compressed, of no said language
  return with_chunk(png, "iTXt", keyword, kPlain, text);
}

std::optional<std::string> text_in(std::span<const std::uint8_t> png, std::string_view keyword) {
  if (!is_png(png)) return {};
  std::string_view rest = characters_of(png).substr(kPngSignature.size());
  const std::string start = std::string(keyword) + '\0';
  for (auto chunk = take_png_chunk(rest); chunk && chunk->type != "IDAT"; chunk = take_png_chunk(rest)) {
    if (chunk->type == "tEXt" && chunk->data.starts_with(start) && chunk->intact()) {
      return std::string(chunk->data.substr(start.size()));
    }
  }
  return {};
}

}  // namespace roadfix
