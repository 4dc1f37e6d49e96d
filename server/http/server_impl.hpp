// What a server is made of: the socket loop, the life of one connection, and that of one request.
#pragma once

#include <httplib.h>

#include <atomic>
#include <exception>
#include <memory>
#include <thread>

#include "server/http/access_log.hpp"
#include "server/http/admission.hpp"
#include "server/http/byte_budget.hpp"
#include "server/http/connection.hpp"
#include "server/http/cors.hpp"
#include "server/http/exchange.hpp"
#include "server/http/held_threads.hpp"
#include "server/http/server.hpp"
#include "server/http/worker_pool.hpp"

namespace roadfix::http {

inline constexpr int kKeepAliveRequests = 10'000;  ///< of one connection

class Server::Impl : public httplib::Server {
 public:
  Impl(ServerSettings settings, Router router, ErrorResponse on_error, Metrics& metrics);

  int start();
  void stop_and_join();

 private:
  std::unique_ptr<WorkerPool> new_pool() const;
  void accept_connections();
  void accept_connection();
  void complain(const char* what, const char* why) noexcept;

  // server_connection.cpp
  bool process_and_close_socket(socket_t socket) override;
  void serve_connection(Connection& connection);
  bool wait_for_request(Connection& connection, bool first) const;
  bool threads_are_wanted() const;
  void write_directly(Connection& connection, const Response& response) const;

  // server_request.cpp
  void set_callbacks();
  bool read_and_answer(auto& connection, bool last, bool& closed_by_client, const auto& take_head);
  bool serve_request(Connection& connection, bool last);
  void refuse_connection(Connection& connection);
  void answer_for_library(Exchange& exchange);
  void end_request(Exchange& exchange, std::exception_ptr thrown);
  void identify(Exchange& exchange) const;
  HandlerResponse before_body(const httplib::Request& head, httplib::Response& out);
  void with_body(const httplib::Request& head, httplib::Response& out, const httplib::ContentReader& reader);
  void hold_thread(Exchange& exchange);
  Response answered(Exchange& exchange);
  Response failed(const Exchange& exchange, std::exception_ptr thrown) const;
  void complete_headers(Exchange& exchange, Response& response) const;
  void reply(Exchange& exchange, httplib::Response& out, Response response) const;
  std::exception_ptr refusal_of_head(const Exchange& exchange, int status) const;
  HandlerResponse complete_error(httplib::Response& out);
  void finished(const httplib::Request& head, const httplib::Response& out);

  const ServerSettings settings_;
  const Router router_;
  const ErrorResponse on_error_;
  Metrics& metrics_;
  const Cors cors_;
  Admission heavy_turns_;
  Admission live_turns_;
  ByteBudget body_memory_;
  HeldThreads held_threads_;
  AccessLog access_log_;
  std::atomic<bool> stopping_ = false;
  std::atomic<Clock::time_point> silent_until_{};  ///< after a complaint
  std::unique_ptr<WorkerPool> pool_;               ///< from start() on
  std::jthread listener_;
};

}  // namespace roadfix::http
