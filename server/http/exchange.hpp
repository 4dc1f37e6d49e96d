// One request and its answer while they pass through cpp-httplib, and the translation between its types and ours.
#pragma once

#include <httplib.h>

#include <chrono>
#include <cstddef>
#include <exception>
#include <string>

#include "server/http/byte_budget.hpp"
#include "server/http/connection.hpp"
#include "server/http/held_threads.hpp"
#include "server/http/message.hpp"
#include "server/http/proxies.hpp"
#include "server/http/router.hpp"

namespace roadfix::http {

struct Exchange {
  explicit Exchange(Connection& stream) : connection(&stream) {}

  Connection* connection;
  Request request;
  ByteBudget::Share body_memory;
  HeldThreads::Share thread;
  Target target;
  RouteMatch match;
  std::string content_type;
  bool packed = false;  ///< the body, by gzip
  std::string problem;  ///< code of the error that is answered
  std::string answer;   ///< Response::answer
  Clock::time_point started = Clock::now();
  bool must_close = true;  ///< bytes of the request may be left unread
  bool asked_to_close = false;
  bool logged = false;
};

/// Called with the head of the request before cpp-httplib acts on it. Takes from it what it would act on in a way we
/// do not want: multipart parsing without limits, byte ranges of generated answers, slow Brotli, gzip up to anywhere
/// in the stream.
void take_over(httplib::Request& head, Exchange& exchange);

/// Method, headers, id and client; not yet target, body and route.
Request translated(const httplib::Request& head, const Exchange& exchange, const Proxies& proxies);

/// Throws InvalidInput ("length-required", "bad-content-length"), InvalidField ("unsupported-content-encoding") or
/// LimitExceeded ("body-too-large") by what the head says.
void check_body_headers(const Request& request, std::size_t max_bytes);
/// Throws InvalidInput "bad-header" for a name that is no token (RFC 9112 5.1), which programs in front may read
/// otherwise, and for other than one Host (RFC 9112 3.2).
void check_headers(const httplib::Request& head);

/// Also a POST without a length: the library leaves out one that is empty, and nobody knows what comes next.
bool announces_body(const Request& request);

struct BodyLimits {
  std::size_t bytes = 0;              ///< after unpacking
  std::chrono::milliseconds time{0};  ///< what the connection allows, to tell of it
  ByteBudget* memory = nullptr;       ///< of the bodies of all requests
};
/// Throws LimitExceeded "body-too-large", Busy where the bodies of others take the memory, Interrupted
/// "request-timeout" or InvalidInput ("body-cut-off", "bad-body-encoding").
void read_body(Exchange& exchange, const httplib::ContentReader& reader, const BodyLimits& limits);

/// Why no head could be read: LimitExceeded "head-too-large", Interrupted "request-timeout", InvalidInput
/// "bad-request".
std::exception_ptr failure_of_head(const Exchange& exchange, std::size_t max_bytes);

void fill(httplib::Response& out, Response response);

/// Of an answer that is about to be written. cpp-httplib adds a length of 0 to answers that have none (RFC 9110 8.6),
/// byte ranges that are not served, and the time that a connection is kept which is closed; it gives no date.
void correct_head(httplib::Response& out);

}  // namespace roadfix::http
