#include "server/http/origins.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <algorithm>

#include "core/units/error.hpp"
#include "core/units/text.hpp"
#include "server/http/url.hpp"

namespace roadfix::http {
namespace {

std::string name_of(const std::string& host) { return lower_case(without_port(host)); }

bool is_this_machine(const std::string& name) {
  if (name == "localhost") return true;
  in_addr v4{};
  constexpr unsigned kLoopback = 127;
  if (inet_pton(AF_INET, name.c_str(), &v4) == 1) return ntohl(v4.s_addr) >> 24U == kLoopback;
  in6_addr v6{};
  return inet_pton(AF_INET6, name.c_str(), &v6) == 1 && IN6_IS_ADDR_LOOPBACK(&v6);
}

}  // namespace

ServedNames::ServedNames(const std::string& host, const std::vector<std::string>& others)
    : any_(others.empty() && !is_this_machine(lower_case(host))), others_{lower_case(host)} {
  for (const std::string& name : others) {
    if (name.empty() || name.find_first_of("/?#@* \t") != std::string::npos || name_of(name) != lower_case(name)) {
      throw InvalidInput("bad-server-name",
                         fmt::format("'{}' is not the name of a host: give one like maps.example.org, without a port "
                                     "and without http://",
                                     name));
    }
    others_.push_back(lower_case(name));
  }
}

void ServedNames::require(const Request& request) const {
  const std::string& host = request.header("host");
  if (any_ || host.empty()) return;
  const std::string name = name_of(host);
  if (is_this_machine(name) || std::ranges::find(others_, name) != others_.end()) return;
  throw InvalidInput("host-not-served",
                     fmt::format("'{}' is not a name of this service: call it localhost, start it with --server-name "
                                 "NAME, or name the proxy in front of it with --proxy",
                                 host.substr(0, 100)));
}

void require_same_site(const Request& request, const std::string& cors_origin) {
  if (request.method != "POST" && request.method != "DELETE") return;
  if (lower_case(request.header("sec-fetch-site")) != "cross-site") return;
  if (cors_origin == "*" || (!cors_origin.empty() && request.header("origin") == cors_origin)) return;
  throw InvalidInput("cross-site-request",
                     fmt::format("a page of '{}' may not change anything here: start the service with --cors-origin if "
                                 "it is to",
                                 request.header("origin").substr(0, 100)));
}

}  // namespace roadfix::http
