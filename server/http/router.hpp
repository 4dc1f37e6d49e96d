// The table of routes: a path is matched segment by segment, so that no request costs more than its length.
#pragma once

#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "server/http/message.hpp"
#include "server/http/url.hpp"

namespace roadfix::http {

enum class Load {
  kLight,
  kLong,   ///< light, but it may hold its thread for long: it waits its turn in a queue of its own, or streams
  kHeavy,  ///< a search or a detection: waits its turn, since only so many run at a time; given up with its client
  kLive,   ///< as heavy, but a flight goes on from it: not given up, with turns beside those of others, which give way
};

/// An answer that needs no turn, or what gives it in one.
using Prepared = std::variant<Response, std::function<Response()>>;

struct Route {
  std::string method;                   ///< GET (which answers HEAD too), POST or DELETE
  std::string path;                     ///< "/v1/maps/{map}/tiles/{z}/{x}/{y}.png"
  std::vector<std::string> parameters;  ///< every query parameter that the route knows; others are refused
  Load load = Load::kLight;
  std::function<Response(const Request&)> handler;
  /// Instead of a handler, where a heavy request depends on others: reads the request and waits for those before it
  /// takes a turn, which they may need, or answers it. A function that it returns is called once in that turn; the
  /// request lives until then, and its body need not.
  std::function<Prepared(Request&)> prepare = {};
};

struct RouteMatch {
  const Route* route = nullptr;
  std::map<std::string, std::string> path_parameters;
};

class Router {
 public:
  void add(Route route);
  const std::vector<Route>& routes() const { return routes_; }

  /// Throws NotFound ("route-not-found") or MethodNotAllowed.
  RouteMatch find(const std::string& method, const std::vector<std::string>& segments) const;
  /// Methods of a path, for Allow and CORS ("GET, HEAD, OPTIONS"); empty where no route has the path.
  std::string allowed_methods(const std::vector<std::string>& segments) const;

 private:
  std::vector<Route> routes_;
  std::vector<std::vector<std::string>> patterns_;
};

/// Throws InvalidField for a name that the route does not know and for one that is given twice.
void check_parameter_names(const Route& route, const Parameters& query);

}  // namespace roadfix::http
