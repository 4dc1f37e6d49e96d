// Which web pages of other origins may read the answers (the CORS protocol of the Fetch standard).
#pragma once

#include <string>

#include "server/http/message.hpp"

namespace roadfix::http {

class Cors {
 public:
  /// An origin as browsers send it, * for all, or empty for none. Throws InvalidInput "bad-cors-origin".
  explicit Cors(std::string origin);

  /// Adds the headers by which the pages may read the answer.
  void open(Response& response) const;

 private:
  std::string origin_;
};

/// The answer to OPTIONS: a browser asks what it may send before it does. `methods` as in Allow.
Response preflight(const std::string& methods);

}  // namespace roadfix::http
