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

Response plain_error(std::exception_ptr thrown, const Request& request) {
  try {
    std::rethrow_exception(std::move(thrown));
  } catch (const Error& error) {
    if (error.code() == "client-gone") return {499, "text/plain", error.code()};
    return {error.code() == "server-busy" ? 503 : 400, "text/plain", error.code()};
  } catch (const std::exception&) {
    return {500, "text/plain", "unexpected " + request.id};
  }
}

class HttpServer : public ::testing::Test {
 protected:
  HttpServer() {
    router_.add({"GET", "/echo", {"text"}, Load::kLight, [](const Request& request) {
                   return Response{200, "text/plain", request.query.empty() ? "" : request.query[0].second};
                 }});
    router_.add({"POST", "/length", {}, Load::kHeavy, [](const Request& request) {
                   return Response{200, "text/plain", std::to_string(request.body.size())};
                 }});
    router_.add({"POST", "/wait", {}, Load::kHeavy, [this](const Request&) {
                   ++waiting_;
                   while (!go_) std::this_thread::sleep_for(1ms);
                   return Response{200, "text/plain", "waited"};
                 }});
    router_.add({"POST", "/answer", {}, Load::kHeavyAnswer, [this](const Request& request) -> Response {
                   ++waiting_;
                   while (!request.abandoned()) std::this_thread::sleep_for(1ms);
                   throw Interrupted("search-interrupted", "as searches do");
                 }});
    router_.add({"POST", "/times", {}, Load::kHeavy, [this](const Request& request) {
                   times_ = {request.received, request.deadline};
                   return Response{200, "text/plain", "done"};
                 }});
    router_.add(
        {"GET", "/throw", {}, Load::kLight, [](const Request&) -> Response { throw std::logic_error("a mistake"); }});
    router_.add({"GET", "/stream", {}, Load::kLight, [](const Request&) {
                   Response response{200, "text/plain", {}};
                   response.stream = [pieces = 0]() mutable -> std::optional<std::string> {
                     return pieces++ < 3 ? std::optional<std::string>("piece ") : std::nullopt;
                   };
                   return response;
                 }});
    router_.add({"GET", "/broken-stream", {}, Load::kLight, [](const Request&) {
                   Response response{200, "text/plain", {}};
                   response.stream = [first = true]() mutable -> std::optional<std::string> {
                     if (!std::exchange(first, false)) throw std::runtime_error("the source has gone");
                     return "piece ";
                   };
                   return response;
                 }});
    settings_.port = 0;
    settings_.crowded_time = 10min;  // however slow the machine is
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
  void wait_for_figure(const std::string& line) const {
    while (metrics_.text().find(line) == std::string::npos) std::this_thread::sleep_for(1ms);
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
  while (client().Get("/echo")) std::this_thread::sleep_for(1ms);  // until it takes nothing new
  go_ = true;
  stopper.join();
  caller.join();
  EXPECT_EQ(answer, "waited");
}

TEST_F(HttpServer, TurnsWhatAHandlerThrowsIntoAnAnswerThatKnowsTheRequest) {
  const auto server = started();
  const auto answer = client().Get("/throw", httplib::Headers{{"X-Request-Id", "flight-7"}});
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 500);
  EXPECT_EQ(answer->body, "unexpected flight-7") << "the log names the request by it";
}

TEST_F(HttpServer, KnowsClientsBehindAProxyByTheirOwnAddress) {
  router_.add({"GET", "/me", {}, Load::kLight, [](const Request& request) {
                 return Response{200, "text/plain", request.client};
               }});
  const httplib::Headers forwarded{{"X-Forwarded-For", "203.0.113.9"}};
  {
    const auto server = started();
    EXPECT_EQ(client().Get("/me", forwarded)->body, "127.0.0.1") << "anybody can write this header";
  }
  settings_.proxies = Proxies({"127.0.0.1"});
  const auto server = started();
  EXPECT_EQ(client().Get("/me", forwarded)->body, "203.0.113.9");
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

TEST_F(HttpServer, LetsGoOfASlowSenderWhileOthersWaitForItsThread) {
  settings_.threads = 1;
  settings_.body_time = 10min;
  settings_.crowded_time = 10ms;
  const auto server = started();
  testing::RawConnection slow(port_);
  slow.send("POST /length HTTP/1.1\r\nHost: x\r\nContent-Length: 100000\r\n\r\nabc");
  while (metrics_.connections == 0) std::this_thread::sleep_for(1ms);
  httplib::Client other = client();
  other.set_read_timeout(60s);
  const auto echo = other.Get("/echo?text=alive");
  ASSERT_TRUE(echo) << "the only thread was kept by a client that sends nothing";
  EXPECT_EQ(echo->body, "alive");
  EXPECT_THAT(slow.read_all(), ::testing::HasSubstr("request-timeout"));
}

TEST_F(HttpServer, WaitsForASlowSenderWhileNobodyElseDoes) {
  settings_.threads = 1;
  settings_.crowded_time = 1ms;
  const auto server = started();
  testing::RawConnection slow(port_);
  slow.send("POST /length HTTP/1.1\r\nHost: x\r\nConnection: close\r\nContent-Length: 5\r\n\r\nab");
  while (metrics_.connections == 0) std::this_thread::sleep_for(1ms);
  std::this_thread::sleep_for(20ms);
  slow.send("cde");
  EXPECT_THAT(slow.read_all(), ::testing::EndsWith("\r\n\r\n5"));
}

TEST_F(HttpServer, GivesNoLengthToAnswersThatHaveNone) {
  const auto server = started();
  const std::string options = raw("OPTIONS /echo HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n");
  EXPECT_THAT(options, ::testing::StartsWith("HTTP/1.1 204"));
  EXPECT_THAT(options, ::testing::Not(::testing::HasSubstr("Content-Length")));
  EXPECT_THAT(options, ::testing::Not(::testing::HasSubstr("Keep-Alive")));
  const std::string head = raw("HEAD /echo?text=abc HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n");
  EXPECT_THAT(head, ::testing::HasSubstr("Content-Length: 3"));
  EXPECT_THAT(head, ::testing::Not(::testing::HasSubstr("Accept-Ranges"))) << "there are none";
}

TEST_F(HttpServer, SaysWhenItAnswered) {
  const auto server = started();
  EXPECT_THAT(client().Get("/echo?text=a")->get_header_value("Date"),
              ::testing::MatchesRegex("[A-Z][a-z][a-z], [0-9][0-9] [A-Z][a-z][a-z] [0-9]+ [0-9:]+ GMT"));
}

TEST_F(HttpServer, PacksOnlyForClientsThatWantIt) {
  const std::string text(2000, 'x');
  router_.add({"GET", "/long", {}, Load::kLight, [&](const Request&) { return Response{200, "text/plain", text}; }});
  const auto server = started();
  const auto is_packed = [&](const std::string& accepted) {
    return raw("GET /long HTTP/1.1\r\nHost: x\r\nConnection: close\r\nAccept-Encoding: " + accepted + "\r\n\r\n")
               .find("Content-Encoding: gzip") != std::string::npos;
  };
  for (const char* accepted : {"gzip", "br, gzip;q=0.5", "*", "GZIP", "deflate, x-gzip"}) {
    EXPECT_TRUE(is_packed(accepted)) << accepted;
  }
  for (const char* accepted : {"gzip;q=0", "gzip; q=0.0, *", "br", "identity", "*;q=0"}) {
    EXPECT_FALSE(is_packed(accepted)) << accepted;
  }
}

TEST_F(HttpServer, RefusesHeaderNamesThatOthersReadDifferently) {
  const auto server = started();
  EXPECT_THAT(raw("POST /length HTTP/1.1\r\nHost: x\r\nContent-Length: 1\r\nTransfer-Encoding : chunked\r\n\r\nx"),
              ::testing::HasSubstr("bad-header"));
  EXPECT_THAT(raw("GET /echo HTTP/1.1\r\nHost: x\r\nX-A: b\r\n folded: c\r\n\r\n"), ::testing::HasSubstr("bad-header"));
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
  const testing::RawConnection queued(port_);  // connections are taken in the order they came
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
    wait_for_figure("roadfix_heavy_waiting 1");
    released = Clock::now();
    go_ = true;
  }
  EXPECT_LE(times_.first, released);
  EXPECT_GE(times_.second, released + settings_.request_time);
}

constexpr const char* kEmptyPost = " HTTP/1.1\r\nHost: x\r\nContent-Length: 0\r\n\r\n";

TEST_F(HttpServer, GivesUpAnswersWhoseClientsHungUpWhetherTheyRunOrWait) {
  settings_.heavy_running = 1;
  settings_.turn_time = 10min;
  const auto server = started();
  {
    testing::RawConnection running(port_);
    running.send("POST /answer" + std::string(kEmptyPost));
    while (waiting_ == 0) std::this_thread::sleep_for(1ms);
    {
      testing::RawConnection queued(port_);
      queued.send("POST /answer" + std::string(kEmptyPost));
      wait_for_figure("roadfix_heavy_waiting 1");
    }
    wait_for_figure("roadfix_heavy_waiting 0");
    EXPECT_NE(metrics_.text().find("roadfix_heavy_running 1"), std::string::npos) << "whose client still waits";
  }
  wait_for_figure(R"(route="/answer",status="499"} 2)");
  EXPECT_EQ(waiting_, 1) << "the one that waited never began";
}

TEST_F(HttpServer, DoesWhatIsMoreThanAnAnswerThoughItsClientHungUp) {
  settings_.heavy_running = 1;
  settings_.turn_time = 10min;
  const auto server = started();
  const std::jthread first([&] { client().Post("/wait", "", "text/plain"); });
  while (waiting_ == 0) std::this_thread::sleep_for(1ms);
  {
    testing::RawConnection queued(port_);
    queued.send("POST /wait" + std::string(kEmptyPost));
    wait_for_figure("roadfix_heavy_waiting 1");
  }
  std::this_thread::sleep_for(300ms);
  go_ = true;
  wait_for_figure(R"(route="/wait",status="200"} 2)");
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
