// JSON from outside, with its depth and size bounded before anything is built from it.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string_view>

namespace roadfix::api {

inline constexpr int kJsonDepth = 16;

/// `max_values` counts numbers, strings, objects and arrays together. Throws InvalidField ("bad-json" with the byte,
/// "json-too-deep", "duplicate-parameter" with the name) or LimitExceeded ("json-too-long").
nlohmann::json parse_json(std::string_view text, std::size_t max_values = 1'000'000);

}  // namespace roadfix::api
