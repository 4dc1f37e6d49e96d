// A line of text beside the pixels of a PNG (chunk tEXt, W3C PNG 11.3.3.2), for what a picture cannot say of itself.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace roadfix {

/// Whether the bytes begin as every PNG does (5.2).
bool is_png(std::span<const std::uint8_t> bytes);

/// The PNG with the text before its pixels. `keyword` has 1 to 79 printable characters, `text` none that is 0.
std::vector<std::uint8_t> with_text(std::span<const std::uint8_t> png, std::string_view keyword, std::string_view text);

/// The same for a text of any language in UTF-8 (chunk iTXt, 11.3.3.4), which text_in() does not look for.
std::vector<std::uint8_t> with_utf8_text(std::span<const std::uint8_t> png, std::string_view keyword,
                                         std::string_view text);

/// The first text under this keyword that stands before the pixels and whose checksum is right. nullopt where there is
/// none, also for bytes that are no PNG.
std::optional<std::string> text_in(std::span<const std::uint8_t> png, std::string_view keyword);

}  // namespace roadfix
