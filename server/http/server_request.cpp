#include <fmt/format.h>

#include <chrono>
#include <exception>
#include <string>
#include <utility>
#include <variant>

#include "core/units/error.hpp"
#include "server/http/errors.hpp"
#include "server/http/give_way.hpp"
#include "server/http/server_impl.hpp"

namespace roadfix::http {
namespace {

using HandlerResponse = httplib::Server::HandlerResponse;

constexpr std::size_t kTargetBytes = 4096;

/// The request that this thread is passing through cpp-httplib, whose callbacks carry no context.
thread_local Exchange* t_exchange = nullptr;

class Passing {
 public:
  explicit Passing(Exchange& exchange) { t_exchange = &exchange; }
  ~Passing() { t_exchange = nullptr; }
  Passing(const Passing&) = delete;
  Passing& operator=(const Passing&) = delete;
};

/// What cpp-httplib packs for those who accept it, of the types that there are here.
bool is_packed_on_request(const std::string& content_type) {
  return content_type.starts_with("application/json") ||
         (content_type.starts_with("text/") && content_type != "text/event-stream");
}

/// cpp-httplib reads the header before it asks anyone.
InvalidInput bad_range() {
  return {"bad-header", "the Range header is not one of bytes=FIRST-LAST: leave it out, since answers come whole"};
}

LimitExceeded url_too_long() {
  return {"url-too-long", fmt::format("the request target is longer than {} bytes", kTargetBytes)};
}

}  // namespace

void Server::Impl::set_callbacks() {
  set_pre_routing_handler([this](const auto& head, auto& out) { return before_body(head, out); });
  Post(R"([\s\S]*)", [this](const auto& head, auto& out, const auto& reader) { with_body(head, out, reader); });
  set_error_handler(HandlerWithResponse([this](const auto&, auto& out) { return complete_error(out); }));
  set_post_routing_handler([](const auto&, auto& out) { correct_head(out); });
  // To serve_request(): the library would answer 500 with the text of the error.
  set_exception_handler(
      [](const auto&, auto&, std::exception_ptr thrown) { std::rethrow_exception(std::move(thrown)); });
  set_logger([this](const auto& head, const auto& out) { finished(head, out); });
}

/// Later versions of the library do not ask the connection for the addresses of its ends.
bool Server::Impl::read_and_answer(auto& connection, bool last, bool& closed_by_client, const auto& take_head) {
  if constexpr (requires { process_request(connection, last, closed_by_client, take_head); }) {
    return process_request(connection, last, closed_by_client, take_head);
  } else {
    std::string remote;
    std::string local;
    int remote_port = 0;
    int local_port = 0;
    connection.get_remote_ip_and_port(remote, remote_port);
    connection.get_local_ip_and_port(local, local_port);
    return process_request(connection, remote, remote_port, local, local_port, last, closed_by_client, take_head);
  }
}

/// Returns whether the connection may serve another one.
bool Server::Impl::serve_request(Connection& connection, bool last) {
  connection.begin_head();
  Exchange exchange(connection);
  const Passing passing(exchange);
  bool closed_by_client = false;
  bool written = false;
  try {
    written =
        read_and_answer(connection, last, closed_by_client, [&](httplib::Request& head) { take_over(head, exchange); });
    if (!connection.has_written()) answer_for_library(exchange);
  } catch (...) {
    end_request(exchange, std::current_exception());
  }
  exchange.thread.give_back();
  if (exchange.must_close) connection.linger([this] { return threads_are_wanted(); });
  return written && !last && !closed_by_client && !exchange.asked_to_close && !exchange.must_close;
}

/// Before anything of a request is read, since no thread is free for it.
void Server::Impl::refuse_connection(Connection& connection) {
  Exchange exchange(connection);
  const Passing passing(exchange);
  end_request(exchange, std::make_exception_ptr(Busy("too many connections wait; try again", std::chrono::seconds(1))));
}

/// cpp-httplib closes without a word where the request line alone is too long, or does not come in time.
void Server::Impl::answer_for_library(Exchange& exchange) {
  switch (exchange.connection->failure()) {
    case Connection::Failure::kHeadTooLarge:
      return end_request(exchange, std::make_exception_ptr(url_too_long()));
    case Connection::Failure::kTimeout:
    case Connection::Failure::kLetGo:
      return end_request(exchange, failure_of_head(exchange, settings_.connection.head_bytes));
    default:
      return;
  }
}

/// By what was thrown outside of handlers, mostly that there is no memory, or what the library says nothing about.
void Server::Impl::end_request(Exchange& exchange, std::exception_ptr thrown) {
  identify(exchange);
  exchange.must_close = true;
  Response response = failed(exchange, std::move(thrown));
  complete_headers(exchange, response);
  if (!exchange.connection->has_written()) write_directly(*exchange.connection, response);
  httplib::Request head;
  head.method = exchange.request.method;
  head.target = exchange.request.path;
  httplib::Response out;
  out.status = response.status;
  finished(head, out);
}

void Server::Impl::identify(Exchange& exchange) const {
  if (!exchange.request.id.empty()) return;
  exchange.request = translated({}, exchange, settings_.proxies);
  int port = 0;
  exchange.connection->get_remote_ip_and_port(exchange.request.client, port);
}

HandlerResponse Server::Impl::before_body(const httplib::Request& head, httplib::Response& out) {
  Exchange& exchange = *t_exchange;
  exchange.request = translated(head, exchange, settings_.proxies);
  Request& request = exchange.request;
  request.received = Clock::now();
  try {
    check_headers(head);
    exchange.must_close =
        announces_body(request) || (head.method != "GET" && head.method != "HEAD" && head.method != "OPTIONS" &&
                                    head.method != "POST" && head.method != "DELETE");
    if (head.target.size() > kTargetBytes) throw url_too_long();
    exchange.target = parse_target(head.target);
    request.path = exchange.target.path;
    request.query = exchange.target.query;
    if (!exchange.target.authority.empty()) request.headers["host"] = exchange.target.authority;
    if (!settings_.proxies.contains(head.remote_addr)) settings_.names.require(request);
    require_same_site(request, settings_.cors_origin);
    if (request.method == "OPTIONS") {
      const std::string allowed = router_.allowed_methods(exchange.target.segments);
      if (allowed.empty()) router_.find(request.method, exchange.target.segments);
      reply(exchange, out, preflight(allowed));
      return HandlerResponse::Handled;
    }
    exchange.match = router_.find(request.method, exchange.target.segments);
    request.path_parameters = exchange.match.path_parameters;
    check_parameter_names(*exchange.match.route, request.query);
    hold_thread(exchange);
    if (request.method == "POST") {
      check_body_headers(request, settings_.body_bytes);
      return HandlerResponse::Unhandled;
    }
  } catch (...) {
    reply(exchange, out, failed(exchange, std::current_exception()));
    return HandlerResponse::Handled;
  }
  reply(exchange, out, answered(exchange));
  return HandlerResponse::Handled;
}

void Server::Impl::with_body(const httplib::Request&, httplib::Response& out, const httplib::ContentReader& reader) {
  Exchange& exchange = *t_exchange;
  try {
    read_body(exchange, reader, {settings_.body_bytes, settings_.connection.body, &body_memory_});
    exchange.must_close = false;
  } catch (...) {
    reply(exchange, out, failed(exchange, std::current_exception()));
    return;
  }
  reply(exchange, out, answered(exchange));
}

/// From before its body is read to the end of its answer.
void Server::Impl::hold_thread(Exchange& exchange) {
  const Load load = exchange.match.route->load;
  if (load == Load::kLong) exchange.thread.take(held_threads_);
  if (load == Load::kHeavy || load == Load::kLive) exchange.thread.take_in_advance(held_threads_);
}

Response Server::Impl::answered(Exchange& exchange) {
  const Counted in_flight(metrics_.in_flight);
  try {
    const Route& route = *exchange.match.route;
    Request& request = exchange.request;
    const Clock::time_point whole = Clock::now();
    request.deadline = whole + settings_.request_time;
    request.abandoned = [&connection = *exchange.connection] { return connection.peer_has_left(); };
    if (route.load == Load::kLight || route.load == Load::kLong) return route.handler(request);
    Prepared prepared = [&] { return route.handler(request); };
    if (route.prepare) prepared = route.prepare(request);
    if (auto* response = std::get_if<Response>(&prepared)) return std::move(*response);
    const bool live = route.load == Load::kLive;
    Admission& turns = live ? live_turns_ : heavy_turns_;
    const Admission::Ticket ticket = turns.enter(request.client, whole + settings_.turn_time,
                                                 live ? nullptr : request.abandoned, held_threads_.too_many());
    request.deadline = Clock::now() + settings_.request_time;
    const auto& work = std::get<std::function<Response()>>(prepared);
    return live ? work() : giving_way(work);
  } catch (const Interrupted&) {
    const bool gone = exchange.request.abandoned();
    return failed(exchange, gone ? std::make_exception_ptr(ClientGone()) : std::current_exception());
  } catch (...) {
    return failed(exchange, std::current_exception());
  }
}

Response Server::Impl::failed(const Exchange& exchange, std::exception_ptr thrown) const {
  return on_error_(std::move(thrown), exchange.request);
}

void Server::Impl::complete_headers(Exchange& exchange, Response& response) const {
  response.headers.emplace_back("X-Request-Id", exchange.request.id);
  cors_.open(response);
  if (is_packed_on_request(response.content_type)) response.headers.emplace_back("Vary", "Accept-Encoding");
  if (exchange.must_close) response.headers.emplace_back("Connection", "close");
  exchange.problem = response.problem;
  exchange.answer = response.answer;
}

void Server::Impl::reply(Exchange& exchange, httplib::Response& out, Response response) const {
  complete_headers(exchange, response);
  fill(out, std::move(response));
}

/// `status` is what cpp-httplib would answer.
std::exception_ptr Server::Impl::refusal_of_head(const Exchange& exchange, int status) const {
  switch (status) {
    case 414:
      return std::make_exception_ptr(url_too_long());
    case 416:
      return std::make_exception_ptr(bad_range());
    default:
      return failure_of_head(exchange, settings_.connection.head_bytes);
  }
}

/// What cpp-httplib answers by itself (a broken request line or header) gets the body that all errors have.
HandlerResponse Server::Impl::complete_error(httplib::Response& out) {
  if (!out.body.empty() || t_exchange == nullptr) return HandlerResponse::Unhandled;
  Exchange& exchange = *t_exchange;
  identify(exchange);
  reply(exchange, out, failed(exchange, refusal_of_head(exchange, out.status)));
  return HandlerResponse::Handled;
}

void Server::Impl::finished(const httplib::Request& head, const httplib::Response& out) {
  Exchange& exchange = *t_exchange;
  if (std::exchange(exchange.logged, true)) return;
  const auto time = Clock::now() - exchange.started;
  const std::string route = exchange.match.route != nullptr ? exchange.match.route->path : "";
  metrics_.count(exchange.match.route != nullptr ? head.method : "-", route.empty() ? "-" : route, out.status, time,
                 out.body.size());
  access_log_.write({std::chrono::system_clock::now(), exchange.request.id, exchange.request.client, head.method,
                     head.target, route, out.status, out.body.size(),
                     std::chrono::duration<double, std::milli>(time).count(), exchange.problem, exchange.answer});
}

}  // namespace roadfix::http
