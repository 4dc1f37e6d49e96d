// The server over real sockets, with handlers of the test's own.
#include "server/http/server.hpp"

#include <gmock/gmock.h>
#include <httplib.h>

#include <atomic>
#include <thread>
#include <utility>

#include "core/units/error.hpp"
#include "server/http/errors.hpp"
#include "tests/support/raw_http.hpp"

namespace roadfix::http {
namespace {

using namespace std::chrono_literals;

Response plain_error(std::exception_ptr thrown) {
  try {
    std::rethrow_exception(std::move(thrown));
  } catch (const Error& error) {
    return {error.code() == "server-busy" ? 503 : 400, "text/plain", error.code()};
  } catch (const std::exception&) {
    return {500, "text/plain", "unexpected"};
  }
}

class HttpServer : public ::testing::Test {
 protected:
  HttpServer() {
    router_.add({"GET", "/echo", {"text"}, false, [](const Request& request) {
                   return Response{200, "text/plain", request.query.empty() ? "" : request.query[0].second};
                 }});
    router_.add({"POST", "/length", {}, true, [](const Request& request) {
                   return Response{200, "text/plain", std::to_string(request.body.size())};
                 }});
    router_.add({"POST", "/wait", {}, true, [this](const Request&) {
                   ++waiting_;
                   while (!go_) std::this_thread::sleep_for(1ms);
                   return Response{200, "text/plain", "waited"};
                 }});
    router_.add({"POST", "/times", {}, true, [this](const Request& request) {
                   times_ = {request.received, request.deadline};
                   return Response{200, "text/plain", "done"};
                 }});
    router_.add({"GET", "/throw", {}, false, [](const Request&) -> Response { throw std::logic_error("a mistake"); }});
    router_.add({"GET", "/stream", {}, false, [](const Request&) {
                   Response response{200, "text/plain", {}};
                   response.stream = [pieces = 0]() mutable -> std::optional<std::string> {
                     return pieces++ < 3 ? std::optional<std::string>("piece ") : std::nullopt;
                   };
                   return response;
                 }});
    router_.add({"GET", "/broken-stream", {}, false, [](const Request&) {
                   Response response{200, "text/plain", {}};
                   response.stream = [first = true]() mutable -> std::optional<std::string> {
                     if (!std::exchange(first, false)) throw std::runtime_error("the source has gone");
                     return "piece ";
                   };
                   return response;
                 }});
    settings_.port = 0;
    settings_.threads = 8;
  }

  std::unique_ptr<Server> started() {
    auto server = std::make_unique<Server>(settings_, router_, plain_error, metrics_);
    port_ = server->start();
    return server;
  }
  httplib::Client client() const {
    httplib::Client client("127.0.0.1", port_);
    client.set_keep_alive(true);
    client.set_tcp_nodelay(true);
    return client;
  }
  std::string raw(const std::string& request) const {
    testing::RawConnection connection(port_);
    connection.send(request);
    return connection.read_all(5s);
  }

  Router router_;
  ServerSettings settings_;
  Metrics metrics_;
  int port_ = 0;
  std::atomic<int> waiting_ = 0;
  std::atomic<bool> go_ = false;
  std::pair<Clock::time_point, Clock::time_point> times_;  ///< received, deadline
};

TEST_F(HttpServer, AnswersManyClientsAtOnceEachWithItsOwn) {
  const auto server = started();
  std::atomic<int> right = 0;
  {
    std::vector<std::jthread> clients;
    for (int i = 0; i < 16; ++i) {
      clients.emplace_back([&, i] {
        httplib::Client c = client();
        for (int k = 0; k < 50; ++k) {
          const std::string text = std::to_string(i * 1000 + k);
          const auto echo = c.Get("/echo?text=" + text);
          const auto length = c.Post("/length", std::string(static_cast<std::size_t>(i * 100 + k), 'x'), "text/plain");
          if (echo && echo->body == text && length && length->body == std::to_string(i * 100 + k)) ++right;
        }
      });
    }
  }
  EXPECT_EQ(right, 800);
  EXPECT_EQ(metrics_.in_flight, 0);
}

TEST_F(HttpServer, FinishesWhatHasBegunWhenItStops) {
  auto server = started();
  std::string answer;
  std::jthread caller([&] {
    const auto result = client().Post("/wait", "", "text/plain");
    if (result) answer = result->body;
  });
  while (waiting_ == 0) std::this_thread::sleep_for(1ms);
  std::jthread stopper([&] { server->stop(); });
  std::this_thread::sleep_for(50ms);
  go_ = true;
  stopper.join();
  caller.join();
  EXPECT_EQ(answer, "waited");
}

TEST_F(HttpServer, TurnsWhatAHandlerThrowsIntoAnAnswer) {
  const auto server = started();
  EXPECT_EQ(client().Get("/throw")->status, 500);
}

TEST_F(HttpServer, StreamsPiecesAndCutsOffAStreamThatFails) {
  const auto server = started();
  EXPECT_EQ(client().Get("/stream")->body, "piece piece piece ");
  EXPECT_FALSE(client().Get("/broken-stream")) << "not taken for whole";
  EXPECT_EQ(client().Get("/echo?text=alive")->body, "alive");
}

TEST_F(HttpServer, EndsAHeadThatComesTooSlowly) {
  settings_.head_time = 100ms;
  const auto server = started();
  EXPECT_THAT(raw("GET /echo HTTP/1.1\r\nHo"), ::testing::HasSubstr("request-timeout"));
}

TEST_F(HttpServer, EndsABodyThatComesTooSlowly) {
  settings_.body_time = 100ms;
  const auto server = started();
  EXPECT_THAT(raw("POST /length HTTP/1.1\r\nHost: x\r\nContent-Length: 10\r\n\r\nabc"),
              ::testing::HasSubstr("request-timeout"));
}

TEST_F(HttpServer, ClosesConnectionsThatStayIdle) {
  settings_.idle_time = 100ms;
  const auto server = started();
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(raw(""), "");
  EXPECT_LT(std::chrono::steady_clock::now() - start, 10s) << "not the usual 15 s";
}

TEST_F(HttpServer, TellsConnectionsBeyondItsQueueToComeBack) {
  settings_.threads = 1;
  settings_.max_waiting_connections = 1;
  const auto server = started();
  std::jthread busy([&] { client().Post("/wait", "", "text/plain"); });
  while (waiting_ == 0) std::this_thread::sleep_for(1ms);
  const testing::RawConnection queued(port_);
  std::this_thread::sleep_for(50ms);
  const std::string answer = raw("");
  EXPECT_THAT(answer, ::testing::StartsWith("HTTP/1.1 503"));
  EXPECT_THAT(answer, ::testing::HasSubstr("Retry-After: 1"));
  go_ = true;
}

TEST_F(HttpServer, CountsTheTimeOfAHeavyRequestFromItsTurnOn) {
  settings_.heavy_running = 1;
  settings_.request_time = 10min;
  settings_.turn_time = 20min;
  const auto server = started();
  Clock::time_point released;
  {
    std::jthread first([&] { client().Post("/wait", "", "text/plain"); });
    while (waiting_ == 0) std::this_thread::sleep_for(1ms);
    std::jthread second([&] { client().Post("/times", "", "text/plain"); });
    while (metrics_.text().find("roadfix_heavy_waiting 1") == std::string::npos) std::this_thread::sleep_for(1ms);
    released = Clock::now();
    go_ = true;
  }
  EXPECT_LE(times_.first, released);
  EXPECT_GE(times_.second, released + settings_.request_time);
}

TEST_F(HttpServer, SendsAwayWhatHasWaitedTooLongForItsTurn) {
  settings_.heavy_running = 1;
  settings_.request_time = 10min;
  settings_.turn_time = 1ms;
  const auto server = started();
  std::jthread first([&] { client().Post("/wait", "", "text/plain"); });
  while (waiting_ == 0) std::this_thread::sleep_for(1ms);
  const auto answer = client().Post("/times", "", "text/plain");
  go_ = true;
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 503);
  EXPECT_EQ(answer->body, "server-busy");
}

TEST_F(HttpServer, SaysWhenItsAddressIsTaken) {
  const auto server = started();
  settings_.port = port_;
  Metrics metrics;
  Server second(settings_, router_, plain_error, metrics);
  EXPECT_THROW(second.start(), IoFailure);
}

TEST_F(HttpServer, CanBeStoppedBeforeItStarted) {
  Server server(settings_, router_, plain_error, metrics_);
  EXPECT_NO_THROW(server.stop());
}

}  // namespace
}  // namespace roadfix::http
