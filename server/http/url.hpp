// The target of a request taken apart: RFC 3986 percent-encoding and the query of HTML forms.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "server/http/message.hpp"

namespace roadfix::http {

struct Target {
  std::string authority;              ///< of a whole URL, as clients of a proxy send it (RFC 9112 3.2.2); else empty
  std::string path;                   ///< as sent
  std::vector<std::string> segments;  ///< decoded one by one, so that an encoded slash stays inside its segment
  Parameters query;
};

/// Throws InvalidInput ("bad-url") with the byte where the percent-encoding is broken or a decoded path holds NUL.
Target parse_target(std::string_view target);

/// The host of "192.0.2.1:4711", "[2001:db8::1]:4711" or "maps.example.org:8080", or of one without a port.
std::string_view without_port(std::string_view host);

/// What a hexadecimal digit stands for; -1 for any other byte.
int hex_digit(char c);

/// "+" is a space where `form` is set. Throws like parse_target; `offset` is added to the byte position.
std::string percent_decoded(std::string_view text, bool form, std::size_t offset = 0);

}  // namespace roadfix::http
