#include "server/api/json_body.hpp"

#include <fmt/format.h>

#include <string>

#include "core/units/error.hpp"
#include "core/units/names_once.hpp"
#include "core/units/text.hpp"
#include "server/http/errors.hpp"

namespace roadfix::api {
namespace {

using http::InvalidField;
using nlohmann::json;

/// Counts brackets and commas outside strings; whether it is JSON at all is left to the parser.
void check_shape(std::string_view text, std::size_t max_values) {
  int depth = 0;
  std::size_t values = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
      continue;
    }
    if (c == '"') in_string = true;
    if (c == ']' || c == '}') --depth;
    const bool opens = c == '[' || c == '{';
    if (opens && ++depth > kJsonDepth) {
      throw InvalidField("json-too-deep", "body", fmt::format("the JSON is nested more than {} deep", kJsonDepth), i);
    }
    if ((opens || c == ',') && ++values > max_values) {
      throw LimitExceeded("json-too-long", fmt::format("the JSON has more than {} values: send fewer", max_values));
    }
  }
}

void refuse_second(const std::string& name) { throw http::given_twice(name); }

/// It holds all of the text or number that cannot be read.
constexpr std::size_t kLongestReason = 300;

/// Without the library's own name of the error: "[json.exception.parse_error.101] parse error at line 1, ...".
std::string reason_of(const json::exception& error) {
  const std::string text = error.what();
  const std::size_t end = text.starts_with('[') ? text.find("] ") : std::string::npos;
  return shortened(end == std::string::npos ? text : text.substr(end + 2), kLongestReason);
}

}  // namespace

json parse_json(std::string_view text, std::size_t max_values) {
  check_shape(text, max_values);
  try {
    return parse_with_names_once(text, refuse_second);
  } catch (const json::parse_error& error) {
    throw InvalidField("bad-json", "body", fmt::format("the body is not JSON: {}", reason_of(error)), error.byte);
  } catch (const json::exception& error) {
    throw InvalidField("bad-json", "body", fmt::format("the body is not usable JSON: {}", reason_of(error)));
  }
}

}  // namespace roadfix::api
