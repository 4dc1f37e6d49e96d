#include "server/http/server.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <exception>
#include <system_error>
#include <utility>

#include "core/units/error.hpp"
#include "server/http/server_impl.hpp"

namespace roadfix::http {
namespace {

using namespace std::chrono_literals;

constexpr int kListenBacklog = 512;
constexpr auto kAcceptPause = 10ms;
constexpr auto kComplaintPause = 10s;

}  // namespace

Server::Impl::Impl(ServerSettings settings, Router router, ErrorResponse on_error, Metrics& metrics)
    : settings_(std::move(settings)),
      router_(std::move(router)),
      on_error_(std::move(on_error)),
      metrics_(metrics),
      cors_(settings_.cors_origin),
      heavy_turns_(settings_.heavy_running, settings_.heavy_waiting),
      live_turns_(settings_.heavy_running, settings_.heavy_waiting),
      body_memory_(std::max(settings_.all_bodies_bytes, settings_.body_bytes)),
      held_threads_(settings_.threads),
      access_log_(settings_.access_log) {
  const auto show = [&](const std::string& load, const std::string& what, const Admission& turns) {
    metrics_.gauge("roadfix_" + load + "_running", what + " that run.", [&turns] { return turns.running(); });
    metrics_.gauge("roadfix_" + load + "_waiting", what + " that wait their turn.",
                   [&turns] { return turns.waiting(); });
  };
  show("heavy", "Searches and detections", heavy_turns_);
  show("live", "Steps of tracks", live_turns_);
  set_tcp_nodelay(true);
  // The connection loop (server_connection.cpp) is ours; these are what the Keep-Alive header says.
  set_keep_alive_max_count(kKeepAliveRequests);
  set_keep_alive_timeout(std::chrono::duration_cast<std::chrono::seconds>(settings_.idle_time).count());
  // Not the library's default: SO_REUSEPORT lets a second service take the same port unnoticed.
  set_socket_options([](socket_t socket) {
    const int on = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  });
  set_callbacks();
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
  while (!stopping_) {
    try {
      accept_connection();
    } catch (const std::exception& error) {
      complain("a connection cannot be accepted", error.what());
      std::this_thread::sleep_for(kAcceptPause);  // until a descriptor or some memory is free
    }
  }
}

void Server::Impl::accept_connection() {
  const int socket = ::accept(svr_sock_, nullptr, nullptr);
  if (socket < 0) {
    const int reason = errno;
    if (stopping_ || reason == EINTR) return;
    throw std::system_error(reason, std::generic_category());
  }
  try {
    pool_->enqueue([this, socket] { process_and_close_socket(socket); });
  } catch (...) {  // no memory to let it wait for a thread
    ::close(socket);
    throw;
  }
}

/// At most once in a while, since what hinders one connection hinders the next ones too.
void Server::Impl::complain(const char* what, const char* why) noexcept {
  const auto now = Clock::now();
  auto silent_until = silent_until_.load();
  if (now < silent_until || !silent_until_.compare_exchange_strong(silent_until, now + kComplaintPause)) return;
  try {
    spdlog::warn("{}: {}", what, why);
  } catch (const std::exception&) {  // no memory to say so either
    silent_until_ = now;
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

Server::Server(ServerSettings settings, Router router, ErrorResponse on_error, Metrics& metrics)
    : impl_(std::make_unique<Impl>(std::move(settings), std::move(router), std::move(on_error), metrics)) {}

Server::~Server() { stop(); }

int Server::start() { return impl_->start(); }

void Server::stop() { impl_->stop_and_join(); }

}  // namespace roadfix::http
