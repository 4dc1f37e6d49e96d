#include "server/http/url.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/units/error.hpp"
#include "core/units/text.hpp"

namespace roadfix::http {
namespace {

[[noreturn]] void refuse(std::size_t byte, std::string_view what) {
  throw InvalidInput("bad-url", fmt::format("byte {} of the request target: {}", byte, what));
}

std::vector<std::string> segments_of(std::string_view path, std::size_t offset) {
  if (path.empty() || path.front() != '/') refuse(offset, "a path starts with '/'");
  std::vector<std::string> segments;
  std::size_t begin = 1;
  while (begin <= path.size()) {
    const std::size_t end = std::min(path.find('/', begin), path.size());
    segments.push_back(percent_decoded(path.substr(begin, end - begin), false, offset + begin));
    if (segments.back().find('\0') != std::string::npos) refuse(offset + begin, "a path holds no NUL");
    begin = end + 1;
  }
  return segments;
}

Parameters parameters_of(std::string_view query, std::size_t offset) {
  Parameters parameters;
  std::size_t begin = 0;
  while (begin < query.size()) {
    const std::size_t end = std::min(query.find('&', begin), query.size());
    const std::string_view pair = query.substr(begin, end - begin);
    if (!pair.empty()) {
      const std::size_t equals = std::min(pair.find('='), pair.size());
      const std::string_view value = equals < pair.size() ? pair.substr(equals + 1) : std::string_view{};
      parameters.emplace_back(percent_decoded(pair.substr(0, equals), true, offset + begin),
                              percent_decoded(value, true, offset + begin + equals + 1));
    }
    begin = end + 1;
  }
  return parameters;
}

constexpr std::string_view kScheme = "http://";

/// Where the path of a whole URL begins; 0 where the target is a path.
std::size_t end_of_authority(std::string_view target) {
  if (lower_case(target.substr(0, kScheme.size())) != kScheme) return 0;
  return std::min(target.find_first_of("/?", kScheme.size()), target.size());
}

}  // namespace

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::string percent_decoded(std::string_view text, bool form, std::size_t offset) {
  std::string decoded;
  decoded.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%') {
      const int high = i + 2 < text.size() ? hex_digit(text[i + 1]) : -1;
      const int low = high >= 0 ? hex_digit(text[i + 2]) : -1;
      if (low < 0) refuse(offset + i, "'%' must be followed by two hexadecimal digits");
      decoded.push_back(static_cast<char>(high * 16 + low));
      i += 2;
    } else {
      decoded.push_back(form && text[i] == '+' ? ' ' : text[i]);
    }
  }
  return decoded;
}

Target parse_target(std::string_view target) {
  target = target.substr(0, target.find('#'));
  const std::size_t begin = end_of_authority(target);
  const std::size_t question = std::min(target.find('?'), target.size());
  Target parsed;
  parsed.path = target.substr(begin, question - begin);
  if (begin > 0) {
    parsed.authority = target.substr(kScheme.size(), begin - kScheme.size());
    if (parsed.path.empty()) parsed.path = "/";
  }
  parsed.segments = segments_of(parsed.path, begin);
  if (question < target.size()) parsed.query = parameters_of(target.substr(question + 1), question + 1);
  return parsed;
}

std::string_view without_port(std::string_view host) {
  if (host.starts_with('[')) return host.substr(1, std::min(host.find(']'), host.size()) - 1);
  return std::ranges::count(host, ':') == 1 ? host.substr(0, host.find(':')) : host;
}

}  // namespace roadfix::http
