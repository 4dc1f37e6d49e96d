// The HTTP/1.1 service: sockets, limits, routing, compression, request ids, access log. Handlers run in its threads.
#pragma once

#include <chrono>
#include <exception>
#include <functional>
#include <memory>
#include <string>

#include "server/http/admission.hpp"
#include "server/http/connection_limits.hpp"
#include "server/http/message.hpp"
#include "server/http/metrics.hpp"
#include "server/http/origins.hpp"
#include "server/http/proxies.hpp"
#include "server/http/router.hpp"

namespace roadfix::http {

struct ServerSettings {
  std::string host = "127.0.0.1";
  int port = 8080;                    ///< 0 = any free one
  int threads = 64;                   ///< connections served at the same time
  int max_waiting_connections = 256;  ///< beyond them new ones are answered 503
  std::chrono::milliseconds idle_time{15'000};
  ConnectionLimits connection = {};
  /// From the end of the body to the answer, or for what waits its turn from its turn on: Request::deadline.
  std::chrono::milliseconds request_time{30'000};
  std::chrono::milliseconds turn_time{30'000};            ///< that a heavy request waits for its turn
  std::size_t body_bytes = std::size_t{64} << 20;         ///< after unpacking
  std::size_t all_bodies_bytes = std::size_t{512} << 20;  ///< of all requests at once; at least body_bytes
  int heavy_running = 2;
  int heavy_waiting = 32;
  std::string cors_origin = {};  ///< see Cors
  ServedNames names = {};        ///< of all but what comes through proxies
  Proxies proxies = {};          ///< whose X-Forwarded-For says who asks
  std::string access_log = {};   ///< see AccessLog
};

/// Renders whatever a handler or the protocol threw, for a request of which at least the id is there (but for
/// connections that are turned away).
using ErrorResponse = std::function<Response(std::exception_ptr, const Request&)>;

class Server {
 public:
  /// `metrics` must outlive the server.
  Server(ServerSettings settings, Router router, ErrorResponse on_error, Metrics& metrics);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Listens from now on; returns the port. Throws IoFailure ("address-not-available", "threads-not-available").
  int start();
  /// Accepts nothing more, answers the requests that have begun, closes.
  void stop();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace roadfix::http
