#include "server/api/multipart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "core/units/error.hpp"
#include "core/units/text.hpp"
#include "server/http/errors.hpp"

namespace roadfix::api {
namespace {

using http::InvalidField;

constexpr std::size_t kMaxBoundary = 70;  // RFC 2046 5.1.1

[[noreturn]] void refuse(const std::string& what, std::size_t byte) {
  throw InvalidField("bad-multipart", "body", fmt::format("the body is not multipart/form-data: {}", what), byte);
}

/// Value of `; name=value` or `; name="value"` in a header.
std::optional<std::string> attribute(std::string_view header, std::string_view name) {
  std::size_t at = header.find(';');
  while (at != std::string_view::npos) {
    const std::string_view rest = trimmed(header.substr(at + 1));
    const std::size_t equals = rest.find('=');
    if (equals == std::string_view::npos) return std::nullopt;
    const std::string_view value = rest.substr(equals + 1);
    const bool is_quoted = value.starts_with('"');
    const std::size_t end = is_quoted ? value.find('"', 1) : std::min(value.find(';'), value.size());
    if (end == std::string_view::npos) return std::nullopt;
    if (lower_case(trimmed(rest.substr(0, equals))) == name) {
      return std::string(is_quoted ? value.substr(1, end - 1) : trimmed(value.substr(0, end)));
    }
    const std::string_view after = value.substr(end);
    const std::size_t next = after.find(';');
    at = next == std::string_view::npos ? next : static_cast<std::size_t>(after.data() - header.data()) + next;
  }
  return std::nullopt;
}

/// Reads the header lines of a part, `at` moves behind the empty line.
Part headers_of(std::string_view body, std::size_t& at) {
  Part part;
  bool named = false;
  for (;;) {
    const std::size_t end = body.find("\r\n", at);
    if (end == std::string_view::npos) refuse("a part's headers do not end", at);
    const std::string_view line = body.substr(at, end - at);
    const std::size_t line_at = std::exchange(at, end + 2);
    if (line.empty()) break;
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos) refuse("a part's header has no colon", line_at);
    const std::string name = lower_case(trimmed(line.substr(0, colon)));
    const std::string_view value = trimmed(line.substr(colon + 1));
    if (name != "content-disposition") continue;
    const auto found = attribute(value, "name");
    if (!found) refuse("a part has no name", line_at);
    part.name = *found;
    named = true;
  }
  if (!named) refuse("a part has no Content-Disposition", at);
  return part;
}

}  // namespace

std::vector<Part> parse_multipart(std::string_view content_type, std::string_view body, std::size_t max_parts) {
  const auto boundary = attribute(content_type, "boundary");
  if (!boundary || boundary->empty() || boundary->size() > kMaxBoundary) {
    throw InvalidField("bad-multipart", "Content-Type",
                       fmt::format("multipart/form-data needs a boundary of 1 to {} characters", kMaxBoundary));
  }
  const std::string delimiter = "\r\n--" + *boundary;
  std::size_t at = 0;
  if (body.starts_with(std::string_view(delimiter).substr(2))) {
    at = delimiter.size() - 2;
  } else if (const auto first = body.find(delimiter); first != std::string_view::npos) {
    at = first + delimiter.size();
  } else {
    refuse("the boundary does not occur", 0);
  }
  std::vector<Part> parts;
  while (!body.substr(at).starts_with("--")) {
    if (!body.substr(at).starts_with("\r\n")) refuse("a boundary is followed by something else than a line end", at);
    at += 2;
    Part part = headers_of(body, at);
    const std::size_t end = body.find(delimiter, at);
    if (end == std::string_view::npos) refuse("the last boundary is missing; was the body cut off?", body.size());
    part.content = body.substr(at, end - at);
    if (parts.size() == max_parts)
      throw LimitExceeded("too-many-parts", fmt::format("the form has more than {} parts; send fewer", max_parts));
    parts.push_back(std::move(part));
    at = end + delimiter.size();
  }
  return parts;
}

}  // namespace roadfix::api
