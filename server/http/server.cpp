#include "server/http/server.hpp"

#include <fmt/format.h>
#include <httplib.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <memory>
#include <system_error>
#include <thread>

#include "core/units/error.hpp"
#include "server/http/access_log.hpp"
#include "server/http/connection.hpp"
#include "server/http/cors.hpp"
#include "server/http/errors.hpp"
#include "server/http/exchange.hpp"
#include "server/http/worker_pool.hpp"

namespace roadfix::http {
namespace {

using namespace std::chrono_literals;
using HandlerResponse = httplib::Server::HandlerResponse;

constexpr int kListenBacklog = 512;
constexpr auto kIdlePoll = 50ms;
/// A connection keeps its thread for so many requests even when others wait for one.
constexpr int kTurnRequests = 32;
constexpr auto kFirstByteGrace = 1s;
constexpr auto kAcceptPause = 10ms;
constexpr auto kComplaintPause = 10s;

/// The request that this thread is passing through cpp-httplib, whose callbacks carry no context.
thread_local Exchange* t_exchange = nullptr;

LimitExceeded url_too_long(std::size_t limit) {
  return {"url-too-long", fmt::format("the request target is longer than {} bytes", limit)};
}

}  // namespace

class Server::Impl : public httplib::Server {
 public:
  Impl(ServerSettings settings, Router router, ErrorResponse on_error, Metrics& metrics);

  int start();
  void stop_and_join();

 private:
  std::unique_ptr<WorkerPool> new_pool() const;
  void accept_connections();
  bool process_and_close_socket(socket_t socket) override;
  bool wait_for_request(Connection& connection, bool first) const;
  void refuse_connection(Connection& connection) const;
  Response failed(const Exchange& exchange, std::exception_ptr thrown) const;

  HandlerResponse before_body(const httplib::Request& head, httplib::Response& out);
  void with_body(const httplib::Request& head, httplib::Response& out, const httplib::ContentReader& reader);
  Response answered(Exchange& exchange);
  void reply(Exchange& exchange, httplib::Response& out, Response response) const;
  HandlerResponse complete_error(httplib::Response& out);
  void finished(const httplib::Request& head, const httplib::Response& out);

  const ServerSettings settings_;
  const Router router_;
  const ErrorResponse on_error_;
  Metrics& metrics_;
  const Cors cors_;
  Admission admission_;
  AccessLog access_log_;
  std::atomic<bool> stopping_ = false;
  std::unique_ptr<WorkerPool> pool_;  ///< from start() on
  std::jthread listener_;
};

Server::Impl::Impl(ServerSettings settings, Router router, ErrorResponse on_error, Metrics& metrics)
    : settings_(std::move(settings)),
      router_(std::move(router)),
      on_error_(std::move(on_error)),
      metrics_(metrics),
      cors_(settings_.cors_origin),
      admission_(settings_.heavy_running, settings_.heavy_waiting),
      access_log_(settings_.access_log) {
  metrics_.gauge("roadfix_heavy_running", "Searches and detections that run.", [this] { return admission_.running(); });
  metrics_.gauge("roadfix_heavy_waiting", "Searches and detections that wait their turn.",
                 [this] { return admission_.waiting(); });
  set_tcp_nodelay(true);
  // The connection loop below is ours; these are what the Keep-Alive header says.
  set_keep_alive_max_count(static_cast<std::size_t>(settings_.keep_alive_requests));
  set_keep_alive_timeout(std::chrono::duration_cast<std::chrono::seconds>(settings_.idle_time).count());
  // Not the library's default: SO_REUSEPORT lets a second service take the same port unnoticed.
  set_socket_options([](socket_t socket) {
    const int on = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  });
  set_pre_routing_handler([this](const auto& head, auto& out) { return before_body(head, out); });
  Post(R"([\s\S]*)", [this](const auto& head, auto& out, const auto& reader) { with_body(head, out, reader); });
  set_error_handler(HandlerWithResponse([this](const auto&, auto& out) { return complete_error(out); }));
  set_post_routing_handler([](const auto&, auto& out) { correct_head(out); });
  set_logger([this](const auto& head, const auto& out) { finished(head, out); });
}

std::unique_ptr<WorkerPool> Server::Impl::new_pool() const {
  try {
    return std::make_unique<WorkerPool>(static_cast<std::size_t>(settings_.threads),
                                        static_cast<std::size_t>(settings_.max_waiting_connections));
  } catch (const std::system_error& error) {
    throw IoFailure("threads-not-available",
                    fmt::format("cannot run {} threads for connections ({}): give fewer with serve --threads, or allow "
                                "the process more (ulimit -u, TasksMax of systemd)",
                                settings_.threads, error.code().message()));
  }
}

int Server::Impl::start() {
  pool_ = new_pool();
  const int port = settings_.port == 0 ? bind_to_any_port(settings_.host)
                                       : (bind_to_port(settings_.host, settings_.port) ? settings_.port : -1);
  if (port < 0) {
    throw IoFailure("address-not-available",
                    fmt::format("cannot listen on {} port {}: in use, not permitted, or not an address of this machine",
                                settings_.host, settings_.port));
  }
  ::listen(svr_sock_, kListenBacklog);
  listener_ = std::jthread([this] { accept_connections(); });
  return port;
}

/// Instead of cpp-httplib's own loop, which ends when one connection cannot be accepted, and the service with it.
void Server::Impl::accept_connections() {
  auto complained = Clock::now() - kComplaintPause;
  while (!stopping_) {
    const int socket = ::accept(svr_sock_, nullptr, nullptr);
    const int reason = errno;
    if (socket >= 0) {
      pool_->enqueue([this, socket] { process_and_close_socket(socket); });
    } else if (!stopping_ && reason != EINTR) {
      if (Clock::now() - complained >= kComplaintPause) {
        spdlog::warn("a connection cannot be accepted: {}", std::generic_category().message(reason));
        complained = Clock::now();
      }
      std::this_thread::sleep_for(kAcceptPause);  // until a descriptor or some memory is free
    }
  }
}

void Server::Impl::stop_and_join() {
  stopping_ = true;
  if (!listener_.joinable()) return;
  ::shutdown(svr_sock_, SHUT_RDWR);  // ends accept()
  listener_.join();
  ::close(svr_sock_.exchange(INVALID_SOCKET));
  pool_->shutdown();
}

bool Server::Impl::process_and_close_socket(socket_t socket) {
  const Counted open(metrics_.connections);
  ConnectionLimits limits{settings_.head_time, settings_.body_time, settings_.write_time, settings_.head_bytes};
  limits.grace = settings_.crowded_time;
  limits.others_wait = [this] { return pool_->waiting() > 0; };
  Connection connection(socket, limits);
  if (WorkerPool::overflow()) {
    refuse_connection(connection);
    return false;
  }
  for (int served = 1; wait_for_request(connection, served == 1); ++served) {
    connection.begin_head();
    Exchange exchange(connection);
    t_exchange = &exchange;
    const bool last =
        stopping_ || served >= settings_.keep_alive_requests || (served >= kTurnRequests && pool_->waiting() > 0);
    bool closed_by_client = false;
    const bool written =
        process_request(connection, last, closed_by_client, [&](httplib::Request& head) { take_over(head, exchange); });
    t_exchange = nullptr;
    if (exchange.must_close || !exchange.head_read) {
      connection.linger([this] { return stopping_ || pool_->waiting() > 0; });
    }
    if (!written || last || closed_by_client || exchange.asked_to_close || exchange.must_close || !exchange.head_read) {
      break;
    }
  }
  return true;
}

bool Server::Impl::wait_for_request(Connection& connection, bool first) const {
  const auto begin = Clock::now();
  while (!stopping_) {
    if (connection.wait(kIdlePoll)) return true;
    const auto idle = Clock::now() - begin;
    const bool others_wait = pool_->waiting() > 0 && (!first || idle > kFirstByteGrace);
    if (connection.at_end() || idle > settings_.idle_time || others_wait) return false;
  }
  return connection.wait(0ms);
}

void Server::Impl::refuse_connection(Connection& connection) const {
  const Response response = on_error_(std::make_exception_ptr(Busy("too many connections wait; try again", 1s)), {});
  const std::string text = fmt::format(
      "HTTP/1.1 {} Service Unavailable\r\nContent-Type: {}\r\nRetry-After: 1\r\nConnection: close\r\n"
      "Content-Length: {}\r\n\r\n{}",
      response.status, response.content_type, response.body.size(), response.body);
  connection.write(text.data(), text.size());
}

Response Server::Impl::failed(const Exchange& exchange, std::exception_ptr thrown) const {
  return on_error_(std::move(thrown), exchange.request);
}

HandlerResponse Server::Impl::before_body(const httplib::Request& head, httplib::Response& out) {
  Exchange& exchange = *t_exchange;
  exchange.request = translated(head, exchange, settings_.proxies);
  Request& request = exchange.request;
  exchange.must_close =
      announces_body(request) || (head.method != "GET" && head.method != "HEAD" && head.method != "OPTIONS" &&
                                  head.method != "POST" && head.method != "DELETE");
  try {
    const bool close = std::exchange(exchange.must_close, true);
    check_headers(head);
    exchange.must_close = close;
    if (head.target.size() > settings_.target_bytes) throw url_too_long(settings_.target_bytes);
    exchange.target = parse_target(head.target);
    request.path = exchange.target.path;
    request.query = exchange.target.query;
    if (!exchange.target.authority.empty()) request.headers["host"] = exchange.target.authority;
    if (request.method == "OPTIONS") {
      const std::string allowed = router_.allowed_methods(exchange.target.segments);
      if (allowed.empty()) router_.find(request.method, exchange.target.segments);
      reply(exchange, out, preflight(allowed));
      return HandlerResponse::Handled;
    }
    exchange.match = router_.find(request.method, exchange.target.segments);
    request.path_parameters = exchange.match.path_parameters;
    check_parameter_names(*exchange.match.route, request.query);
    if (request.method == "POST") {
      check_body_headers(request, settings_.body_bytes);
      exchange.must_close = false;
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
    read_body(exchange, reader, settings_.body_bytes, settings_.body_time);
  } catch (...) {
    exchange.must_close = true;
    reply(exchange, out, failed(exchange, std::current_exception()));
    return;
  }
  reply(exchange, out, answered(exchange));
}

Response Server::Impl::answered(Exchange& exchange) {
  const Counted in_flight(metrics_.in_flight);
  try {
    const Route& route = *exchange.match.route;
    Request& request = exchange.request;
    request.received = Clock::now();
    request.deadline = request.received + settings_.request_time;
    request.abandoned = [&connection = *exchange.connection] { return connection.peer_has_left(); };
    if (route.load == Load::kLight) return route.handler(request);
    const auto prepared = route.prepare ? route.prepare(request) : nullptr;
    const auto given_up = route.load == Load::kHeavyAnswer ? request.abandoned : nullptr;
    const Admission::Ticket ticket = admission_.enter(request.received + settings_.turn_time, given_up);
    request.deadline = Clock::now() + settings_.request_time;
    return prepared ? prepared() : route.handler(request);
  } catch (const Interrupted&) {
    const bool gone = exchange.request.abandoned();
    return failed(exchange, gone ? std::make_exception_ptr(ClientGone()) : std::current_exception());
  } catch (...) {
    return failed(exchange, std::current_exception());
  }
}

void Server::Impl::reply(Exchange& exchange, httplib::Response& out, Response response) const {
  response.headers.emplace_back("X-Request-Id", exchange.request.id);
  cors_.open(response);
  if (response.content_type.starts_with("application/json")) response.headers.emplace_back("Vary", "Accept-Encoding");
  if (exchange.must_close) response.headers.emplace_back("Connection", "close");
  exchange.problem = response.problem;
  fill(out, std::move(response));
}

/// What cpp-httplib answers by itself (a broken request line or header) gets the body that all errors have.
HandlerResponse Server::Impl::complete_error(httplib::Response& out) {
  if (!out.body.empty() || t_exchange == nullptr) return HandlerResponse::Unhandled;
  Exchange& exchange = *t_exchange;
  if (exchange.request.id.empty()) {
    exchange.request = translated({}, exchange, settings_.proxies);
    int port = 0;
    exchange.connection->get_remote_ip_and_port(exchange.request.client, port);
  }
  exchange.must_close = true;
  const bool long_line = out.status == 414;
  const auto thrown = long_line ? std::make_exception_ptr(url_too_long(settings_.target_bytes))
                                : failure_of_head(exchange, settings_.head_bytes);
  reply(exchange, out, failed(exchange, thrown));
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
                     std::chrono::duration<double, std::milli>(time).count(), exchange.problem});
}

Server::Server(ServerSettings settings, Router router, ErrorResponse on_error, Metrics& metrics)
    : impl_(std::make_unique<Impl>(std::move(settings), std::move(router), std::move(on_error), metrics)) {}

Server::~Server() { stop(); }

int Server::start() { return impl_->start(); }

void Server::stop() { impl_->stop_and_join(); }

}  // namespace roadfix::http
