// Which requests a browser may have sent for a page that is none of ours. Names lead to any address (DNS rebinding), so
// that a service is within reach of every page that is open on a machine that reaches it, be it its own alone.
#pragma once

#include <string>
#include <vector>

#include "server/http/message.hpp"

namespace roadfix::http {

class ServedNames {
 public:
  /// Any.
  ServedNames() = default;
  /// Of a service that listens on `host`: any, but where that is this machine alone or `others` are told, `host`,
  /// localhost, its addresses (127.0.0.0/8, ::1) and `others`, in any case and without a port. Throws InvalidInput
  /// ("bad-server-name").
  ServedNames(const std::string& host, const std::vector<std::string>& others);

  /// Throws InvalidInput "host-not-served". What names no host was sent by no browser.
  void require(const Request& request) const;

 private:
  bool any_ = true;
  std::vector<std::string> others_;  ///< beside those of this machine
};

/// Throws InvalidInput "cross-site-request" for one that would change something, of a page of another site that
/// `cors_origin` does not name: a browser asks first for some of these only.
void require_same_site(const Request& request, const std::string& cors_origin);

}  // namespace roadfix::http
