#include <fmt/format.h>

#include <chrono>
#include <exception>
#include <string>
#include <string_view>

#include "server/http/server_impl.hpp"

namespace roadfix::http {
namespace {

using namespace std::chrono_literals;

constexpr auto kIdlePoll = 50ms;
/// A connection keeps its thread for so many requests even when others wait for one.
constexpr int kTurnRequests = 32;
constexpr auto kFirstByteGrace = 1s;
/// Where there is no memory for an answer of our own.
constexpr std::string_view kUnavailable =
    "HTTP/1.1 503 Service Unavailable\r\nRetry-After: 5\r\nConnection: close\r\nContent-Length: 0\r\n\r\n";

const char* phrase_of(int status) {
  switch (status) {
    case 408:
      return "Request Timeout";
    case 414:
      return "URI Too Long";
    case 503:
      return "Service Unavailable";
    default:
      return "Internal Server Error";
  }
}

}  // namespace

bool Server::Impl::process_and_close_socket(socket_t socket) {
  const Counted open(metrics_.connections);
  Connection connection(socket, settings_.connection, [this] { return threads_are_wanted(); });
  try {
    serve_connection(connection);
  } catch (const std::exception& error) {  // it would end the process
    if (!connection.has_written()) connection.write(kUnavailable.data(), kUnavailable.size());
    complain("a connection was closed", error.what());
  }
  return true;
}

void Server::Impl::serve_connection(Connection& connection) {
  if (WorkerPool::overflow()) {
    refuse_connection(connection);
    return;
  }
  for (int served = 1; wait_for_request(connection, served == 1); ++served) {
    const bool last = stopping_ || served >= kKeepAliveRequests || (served >= kTurnRequests && pool_->waiting() > 0);
    if (!serve_request(connection, last)) break;
  }
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

/// By others that wait, or by the end of the service: who sends slowly is waited for no longer.
bool Server::Impl::threads_are_wanted() const { return stopping_ || pool_->waiting() > 0; }

/// What is not answered through cpp-httplib: no request was read, or it gave up.
void Server::Impl::write_directly(Connection& connection, const Response& response) const {
  std::string text = fmt::format("HTTP/1.1 {} {}\r\n", response.status, phrase_of(response.status));
  for (const auto& [name, value] : response.headers) text += fmt::format("{}: {}\r\n", name, value);
  text += fmt::format("Content-Type: {}\r\nContent-Length: {}\r\n\r\n{}", response.content_type, response.body.size(),
                      response.body);
  connection.write(text.data(), text.size());
}

}  // namespace roadfix::http
