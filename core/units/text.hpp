// Texts that machines compare.
#pragma once

#include <string>
#include <string_view>

namespace roadfix {

/// Letters A to Z become small, whatever the locale; all other bytes stay.
std::string lower_case(std::string_view text);

}  // namespace roadfix
