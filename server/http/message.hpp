// What handlers see of HTTP: a request that was read whole, and the answer to it. Free of any HTTP library.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace roadfix::http {

using Clock = std::chrono::steady_clock;

/// In the order of the request, percent-decoded; a name may occur twice.
using Parameters = std::vector<std::pair<std::string, std::string>>;

struct Request {
  std::string method;
  std::string path;                                    ///< as sent, without the query
  std::map<std::string, std::string> path_parameters;  ///< decoded, by the names in the route
  Parameters query;
  std::map<std::string, std::string> headers;  ///< lower-case names; repeated ones joined with ", "
  std::string body;                            ///< unpacked if it was sent with gzip
  std::string id;                              ///< of the client (X-Request-Id) or made up; echoed
  std::string client;                          ///< address of the peer
  Clock::time_point received;                  ///< its head; a body may take long to follow
  Clock::time_point deadline = Clock::time_point::max();
  /// Whether the client has hung up and waits for no answer. Any thread may ask while the request is answered.
  std::function<bool()> abandoned = [] { return false; };

  /// Empty where the header is absent.
  const std::string& header(const std::string& lower_case_name) const;
  /// Media type of the body in lower case, without parameters ("image/png").
  std::string media_type() const;
};

struct Response {
  int status = 200;
  std::string content_type;
  std::string body;
  std::vector<std::pair<std::string, std::string>> headers = {};
  /// Instead of a body: called again and again for the next piece (which may be empty) until there is none or the
  /// client has left. May wait, but not for long.
  std::function<std::optional<std::string>()> stream = {};
  std::string problem = {};  ///< its code, where the answer is an error
  std::string answer = {};   ///< in a word, for the access log: "fix", "converged"; empty where there is none
};

}  // namespace roadfix::http
