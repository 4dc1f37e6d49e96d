#include "server/http/cors.hpp"

#include <fmt/format.h>

#include <utility>

#include "core/units/error.hpp"

namespace roadfix::http {
namespace {

/// What browsers send as Origin and compare byte by byte (RFC 6454 7): a slash at its end, and no page is let in.
bool is_origin(const std::string& text) {
  if (text == "*") return true;
  const std::size_t host = text.find("://");
  return host != std::string::npos && host > 0 && host + 3 < text.size() &&
         text.find_first_of("/?#, \t\r\n*", host + 3) == std::string::npos;
}

}  // namespace

Cors::Cors(std::string origin) : origin_(std::move(origin)) {
  if (origin_.empty() || is_origin(origin_)) return;
  throw InvalidInput("bad-cors-origin", fmt::format("'{}' is not an origin as browsers send it: give * or one like "
                                                    "https://ops.example.org or http://10.0.0.5:3000, without a path",
                                                    origin_));
}

void Cors::open(Response& response) const {
  if (origin_.empty()) return;
  response.headers.emplace_back("Access-Control-Allow-Origin", origin_);
  // Without this a page reads nothing but the body: neither Roadfix-Status nor Roadfix-Pose, ETag or Retry-After.
  response.headers.emplace_back("Access-Control-Expose-Headers", "*");
  if (origin_ != "*") response.headers.emplace_back("Vary", "Origin");
}

Response preflight(const std::string& methods) {
  return {204,
          {},
          {},
          {{"Allow", methods},
           {"Access-Control-Allow-Methods", methods},
           {"Access-Control-Allow-Headers",
            "Accept, Authorization, Content-Encoding, Content-Type, If-None-Match, Last-Event-ID, X-Request-Id"},
           {"Access-Control-Max-Age", "600"}}};
}

}  // namespace roadfix::http
