// The server over real sockets, with handlers of the tests' own.
#pragma once

#include <gtest/gtest.h>
#include <httplib.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "core/units/error.hpp"
#include "server/http/errors.hpp"
#include "server/http/server.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/raw_http.hpp"

namespace roadfix::testing {

inline http::Response plain_error(std::exception_ptr thrown, const http::Request& request) {
  try {
    std::rethrow_exception(std::move(thrown));
  } catch (const http::Busy& busy) {
    return {503, "text/plain", busy.code(), {{"Retry-After", std::to_string(busy.retry_after().count())}}};
  } catch (const Error& error) {
    if (error.code() == "client-gone") return {499, "text/plain", error.code()};
    return {400, "text/plain", error.code()};
  } catch (const std::bad_alloc&) {
    return {503, "text/plain", "no-memory"};
  } catch (const std::exception&) {
    return {500, "text/plain", "unexpected " + request.id};
  }
}

class HttpServerTest : public ::testing::Test {
 protected:
  HttpServerTest() {
    router_.add({"GET", "/echo", {"text"}, http::Load::kLight, [](const http::Request& request) {
                   return http::Response{200, "text/plain", request.query.empty() ? "" : request.query[0].second};
                 }});
    router_.add({"POST", "/length", {}, http::Load::kHeavy, [](const http::Request& request) {
                   return http::Response{200, "text/plain", std::to_string(request.body.size())};
                 }});
    for (const auto& [path, load] : {std::pair("/wait", http::Load::kHeavy), std::pair("/step", http::Load::kLive)}) {
      router_.add({"POST", path, {}, load, [this](const http::Request&) {
                     ++waiting_;
                     while (!go_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
                     return http::Response{200, "text/plain", "waited"};
                   }});
    }
    router_.add({"POST", "/answer", {}, http::Load::kHeavy, [this](const http::Request& request) -> http::Response {
                   ++waiting_;
                   while (!request.abandoned()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
                   throw Interrupted("search-interrupted", "as searches do");
                 }});
    router_.add({"POST", "/times", {}, http::Load::kHeavy, [this](const http::Request& request) {
                   received_ = request.received;
                   deadline_ = request.deadline;
                   return http::Response{200, "text/plain", "done"};
                 }});
    router_.add({"GET", "/throw", {}, http::Load::kLight, [](const http::Request&) -> http::Response {
                   throw std::logic_error("a mistake");
                 }});
    router_.add({"GET", "/stream", {}, http::Load::kLight, [](const http::Request&) {
                   http::Response response{200, "text/plain", {}};
                   response.stream = [pieces = 0]() mutable -> std::optional<std::string> {
                     return pieces++ < 3 ? std::optional<std::string>("piece ") : std::nullopt;
                   };
                   return response;
                 }});
    router_.add({"GET", "/broken-stream", {}, http::Load::kLight, [](const http::Request&) {
                   http::Response response{200, "text/plain", {}};
                   response.stream = [first = true]() mutable -> std::optional<std::string> {
                     if (!std::exchange(first, false)) throw std::runtime_error("the source has gone");
                     return "piece ";
                   };
                   return response;
                 }});
    settings_.port = 0;
    settings_.connection.grace = std::chrono::minutes(10);  // however slow the machine is
    settings_.threads = 8;
  }

  std::unique_ptr<http::Server> started() {
    auto server = std::make_unique<http::Server>(settings_, router_, plain_error, metrics_);
    port_ = server->start();
    return server;
  }
  httplib::Client client() const {
    httplib::Client client("127.0.0.1", port_);
    client.set_keep_alive(true);
    client.set_tcp_nodelay(true);
    return client;
  }
  void wait_for_figure(const std::string& line) const {
    EXPECT_TRUE(eventually([&] { return metrics_.text().find(line) != std::string::npos; }))
        << "there is no figure " << line;
  }
  std::string raw(const std::string& request) const {
    RawConnection connection(port_);
    connection.send(request);
    return connection.read_all(std::chrono::seconds(5));
  }

  http::Router router_;
  http::ServerSettings settings_;
  http::Metrics metrics_;
  int port_ = 0;
  std::atomic<int> waiting_ = 0;
  std::atomic<bool> go_ = false;
  std::atomic<http::Clock::time_point> received_, deadline_;  ///< of POST /times
};

}  // namespace roadfix::testing
