#include "server/http/router.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "core/units/error.hpp"
#include "server/http/errors.hpp"

namespace roadfix::http {
namespace {

using PathParameters = std::map<std::string, std::string>;

/// Matches one segment against "literal", "{name}" or "{name}.suffix".
bool match_segment(const std::string& pattern, const std::string& segment, PathParameters& parameters) {
  if (pattern.empty() || pattern.front() != '{') return pattern == segment;
  const std::size_t close = pattern.find('}');
  const std::string suffix = pattern.substr(close + 1);
  if (segment.size() <= suffix.size() || !segment.ends_with(suffix)) return false;
  parameters[pattern.substr(1, close - 1)] = segment.substr(0, segment.size() - suffix.size());
  return true;
}

bool match_path(const std::vector<std::string>& pattern, const std::vector<std::string>& segments,
                PathParameters& parameters) {
  if (pattern.size() != segments.size()) return false;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    if (!match_segment(pattern[i], segments[i], parameters)) return false;
  }
  return true;
}

bool answers(const Route& route, const std::string& method) {
  return route.method == method || (method == "HEAD" && route.method == "GET");
}

}  // namespace

void Router::add(Route route) {
  patterns_.push_back(parse_target(route.path).segments);
  routes_.push_back(std::move(route));
}

RouteMatch Router::find(const std::string& method, const std::vector<std::string>& segments) const {
  for (std::size_t i = 0; i < routes_.size(); ++i) {
    RouteMatch match{&routes_[i], {}};
    if (answers(routes_[i], method) && match_path(patterns_[i], segments, match.path_parameters)) return match;
  }
  const std::string allowed = allowed_methods(segments);
  if (!allowed.empty()) throw MethodNotAllowed(method, allowed);
  throw NotFound("route-not-found", "nothing is at this path; GET /openapi.json lists what there is");
}

std::string Router::allowed_methods(const std::vector<std::string>& segments) const {
  std::set<std::string> methods;
  for (std::size_t i = 0; i < routes_.size(); ++i) {
    PathParameters ignored;
    if (!match_path(patterns_[i], segments, ignored)) continue;
    methods.insert(routes_[i].method);
    if (routes_[i].method == "GET") methods.insert("HEAD");
  }
  if (methods.empty()) return {};
  methods.insert("OPTIONS");
  return fmt::format("{}", fmt::join(methods, ", "));
}

void check_parameter_names(const Route& route, const Parameters& query) {
  std::set<std::string> seen;
  for (const auto& [name, value] : query) {
    if (std::ranges::find(route.parameters, name) == route.parameters.end()) {
      throw InvalidField(
          "unknown-parameter", name,
          fmt::format("'{}' is not a parameter of {} {}; allowed: {}", name, route.method, route.path,
                      route.parameters.empty() ? "none" : fmt::format("{}", fmt::join(route.parameters, ", "))));
    }
    if (!seen.insert(name).second) throw given_twice(name);
  }
}

}  // namespace roadfix::http
