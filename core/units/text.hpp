// Texts that machines compare.
#pragma once

#include <string>
#include <string_view>

namespace roadfix {

/// Letters A to Z become small, whatever the locale; all other bytes stay.
std::string lower_case(std::string_view text);

/// Without the spaces and tabs around it.
std::string_view trimmed(std::string_view text);

/// Without the mark that spreadsheets write before UTF-8.
std::string_view without_byte_order_mark(std::string_view text);

}  // namespace roadfix
