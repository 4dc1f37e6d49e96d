// How long the server waits for those who send slowly, or nothing, how long others wait for it.
#include <gmock/gmock.h>

#include <optional>

#include "tests/server/http/server_fixture.hpp"

namespace roadfix::http {
namespace {

using namespace std::chrono_literals;
using testing::eventually;

class HttpServerTimes : public testing::HttpServerTest {
 protected:
  static constexpr std::size_t kLargeAnswer = std::size_t{64} << 20;  // more than the system takes for its reader
  void add_large_answer() {
    router_.add({"GET", "/large", {}, Load::kLight, [](const Request&) {
                   return Response{200, "image/png", std::string(kLargeAnswer, 'x')};
                 }});
  }
  /// Has a thread, has sent a part of its body, and sends no more.
  std::unique_ptr<testing::RawConnection> stalled() const {
    auto slow = std::make_unique<testing::RawConnection>(port_);
    slow->send("POST /length HTTP/1.1\r\nHost: x\r\nContent-Length: 100000\r\n\r\nabc");
    wait_for_figure("roadfix_connections 1\n");
    return slow;
  }
};

TEST_F(HttpServerTimes, EndsAHeadThatComesTooSlowly) {
  settings_.connection.head = 100ms;
  const auto server = started();
  for (const char* begun : {"GET /echo HTTP/1.1\r\nHo", "GET /ec"}) {
    EXPECT_THAT(raw(begun), ::testing::HasSubstr("request-timeout")) << begun;
  }
}

TEST_F(HttpServerTimes, EndsABodyThatComesTooSlowly) {
  settings_.connection.body = 100ms;
  const auto server = started();
  EXPECT_THAT(raw("POST /length HTTP/1.1\r\nHost: x\r\nContent-Length: 10\r\n\r\nabc"),
              ::testing::HasSubstr("request-timeout"));
}

TEST_F(HttpServerTimes, SaysHowLongABodyMayTakeSoThatNobodyRepeatsItForEver) {
  settings_.connection.body = 50ms;
  Server server(
      settings_, router_,
      [](std::exception_ptr thrown, const Request&) {
        try {
          std::rethrow_exception(std::move(thrown));
        } catch (const Error& error) {
          return Response{408, "text/plain", error.what()};
        }
      },
      metrics_);
  port_ = server.start();
  EXPECT_THAT(raw("POST /length HTTP/1.1\r\nHost: x\r\nContent-Length: 10\r\n\r\nabc"),
              ::testing::AllOf(::testing::HasSubstr("3 bytes of the body came within 0.05 s"),
                               ::testing::HasSubstr("--body-time")));
}

TEST_F(HttpServerTimes, LetsGoOfASlowSenderWhileOthersWaitForItsThread) {
  settings_.threads = 1;
  settings_.connection.body = 10min;
  settings_.connection.grace = 10ms;
  const auto server = started();
  const auto slow = stalled();
  httplib::Client other = client();
  other.set_read_timeout(60s);
  const auto echo = other.Get("/echo?text=alive");
  ASSERT_TRUE(echo) << "the only thread was kept by a client that sends nothing";
  EXPECT_EQ(echo->body, "alive");
  EXPECT_THAT(slow->read_all(), ::testing::HasSubstr("request-timeout"));
}

TEST_F(HttpServerTimes, LetsGoOfASenderThatStandsStillHoweverMuchItSentBefore) {
  settings_.threads = 1;
  settings_.connection.body = 10min;
  settings_.connection.grace = 10ms;
  const auto server = started();
  testing::RawConnection slow(port_);
  slow.send("POST /length HTTP/1.1\r\nHost: x\r\nContent-Length: 10000000\r\n\r\n" + std::string(1'000'000, 'x'));
  wait_for_figure("roadfix_connections 1\n");
  httplib::Client other = client();
  other.set_read_timeout(60s);
  ASSERT_TRUE(other.Get("/echo?text=alive")) << "a million bytes made up for minutes of silence";
  EXPECT_THAT(slow.read_all(), ::testing::HasSubstr("request-timeout"));
}

TEST_F(HttpServerTimes, LetsGoOfAReaderThatStandsStillWhileOthersWaitForItsThread) {
  add_large_answer();
  settings_.threads = 1;
  settings_.connection.write = 10min;
  settings_.connection.grace = 10ms;
  const auto server = started();
  testing::RawConnection deaf(port_);
  deaf.send("GET /large HTTP/1.1\r\nHost: x\r\n\r\n");
  wait_for_figure("roadfix_connections 1\n");
  httplib::Client other = client();
  other.set_read_timeout(60s);
  ASSERT_TRUE(other.Get("/echo?text=alive")) << "the only thread was kept by a client that reads nothing";
  EXPECT_LT(deaf.read_all().size(), kLargeAnswer);
}

TEST_F(HttpServerTimes, WaitsForAReaderThatIsSlowButReads) {
  add_large_answer();
  settings_.threads = 1;
  settings_.connection.grace = 1s;
  const auto server = started();
  httplib::Client slow = client();
  std::size_t read = 0;
  std::jthread other;
  const auto pieces = [&](const char*, std::size_t size) {
    if (read == 0) other = std::jthread([&] { client().Get("/echo?text=waiting"); });
    read += size;
    std::this_thread::sleep_for(size * std::chrono::nanoseconds(2s) / kLargeAnswer);
    return true;
  };
  ASSERT_TRUE(slow.Get("/large", httplib::Headers{{"Connection", "close"}}, pieces));
  EXPECT_EQ(read, kLargeAnswer);
}

TEST_F(HttpServerTimes, LetsGoOfASlowSenderWhenItIsStopped) {
  settings_.connection.body = 10min;
  settings_.connection.grace = 10ms;
  const auto server = started();
  const auto slow = stalled();
  const auto start = std::chrono::steady_clock::now();
  server->stop();
  EXPECT_LT(std::chrono::steady_clock::now() - start, 60s);
  EXPECT_THAT(slow->read_all(), ::testing::HasSubstr("request-timeout"));
}

TEST_F(HttpServerTimes, SendsABodyAwayForWhichOthersLeaveNoMemoryAndTakesItLater) {
  settings_.body_bytes = 50'000;
  settings_.all_bodies_bytes = 60'000;
  settings_.connection.body = 10min;
  const auto server = started();
  const std::string body(40'000, 'x');
  // The slow one needs a moment to send what it holds, and its end one to be noticed.
  const auto posted_until_it_is_not = [&](int unwanted) {
    auto answer = client().Post("/length", body, "text/plain");
    for (int tries = 0; answer && answer->status == unwanted && tries < 1000; ++tries) {
      answer = client().Post("/length", body, "text/plain");
    }
    return answer;
  };
  std::optional<testing::RawConnection> slow;
  int status = 0;
  for (int tries = 0; tries < 10 && status != 503; ++tries) {
    slow.emplace(port_);  // one that came while another was posted was sent away itself
    slow->send("POST /length HTTP/1.1\r\nHost: x\r\nContent-Length: 50000\r\n\r\n" + body);
    const auto answer = posted_until_it_is_not(200);
    ASSERT_TRUE(answer);
    status = answer->status;
  }
  EXPECT_EQ(status, 503);
  slow.reset();
  const auto later = posted_until_it_is_not(503);
  ASSERT_TRUE(later);
  EXPECT_EQ(later->body, "40000");
}

TEST_F(HttpServerTimes, ListensToARefusedBodySoThatItsSlowSenderLearnsWhy) {
  const auto server = started();
  const auto slowly = [](std::size_t, std::size_t, httplib::DataSink& sink) {
    std::this_thread::sleep_for(100ms);
    return sink.write("x", 1);
  };
  const auto answer = client().Post("/nowhere", 12, slowly, "text/plain");
  ASSERT_TRUE(answer) << "the connection was broken while the body was sent";
  EXPECT_EQ(answer->body, "route-not-found");
}

TEST_F(HttpServerTimes, ListensToARefusedBodyOnlyWhileNobodyElseWaits) {
  settings_.threads = 1;
  settings_.connection.body = 10min;
  const auto server = started();
  testing::RawConnection refused(port_);
  refused.send("POST /nowhere HTTP/1.1\r\nHost: x\r\nContent-Length: 100000\r\n\r\n");
  const std::jthread sender([&](const std::stop_token& stop) {
    for (; !stop.stop_requested(); std::this_thread::sleep_for(20ms)) refused.send("x");
  });
  httplib::Client other = client();
  other.set_read_timeout(60s);
  ASSERT_TRUE(other.Get("/echo?text=alive")) << "the only thread was kept by a body that nobody wants";
}

TEST_F(HttpServerTimes, WaitsForASlowSenderWhileNobodyElseDoes) {
  settings_.threads = 1;
  settings_.connection.grace = 1ms;
  const auto server = started();
  testing::RawConnection slow(port_);
  slow.send("POST /length HTTP/1.1\r\nHost: x\r\nConnection: close\r\nContent-Length: 5\r\n\r\nab");
  EXPECT_TRUE(eventually([&] { return metrics_.connections > 0; }));
  std::this_thread::sleep_for(20ms);
  slow.send("cde");
  EXPECT_THAT(slow.read_all(), ::testing::EndsWith("\r\n\r\n5"));
}

TEST_F(HttpServerTimes, CountsNoTimeOfItsOwnAgainstTheSenderOfTheNextRequest) {
  settings_.threads = 1;
  settings_.connection.grace = 1ms;
  const auto server = started();
  testing::RawConnection patient(port_);
  patient.send("POST /wait HTTP/1.1\r\nHost: x\r\nContent-Length: 0\r\n\r\n");
  EXPECT_TRUE(eventually([&] { return waiting_ > 0; }));
  patient.send("GET /echo?text=next HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n");
  const testing::RawConnection queued(port_);
  std::this_thread::sleep_for(20ms);
  go_ = true;
  EXPECT_THAT(patient.read_all(), ::testing::EndsWith("\r\n\r\nnext"));
}

TEST_F(HttpServerTimes, ClosesConnectionsThatStayIdle) {
  settings_.idle_time = 100ms;
  const auto server = started();
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(raw(""), "");
  EXPECT_LT(std::chrono::steady_clock::now() - start, 10s) << "not the usual 15 s";
}

TEST_F(HttpServerTimes, TellsConnectionsBeyondItsQueueToComeBack) {
  settings_.threads = 1;
  settings_.max_waiting_connections = 1;
  const auto server = started();
  std::jthread busy([&] { client().Post("/wait", "", "text/plain"); });
  EXPECT_TRUE(eventually([&] { return waiting_ > 0; }));
  const testing::RawConnection queued(port_);  // connections are taken in the order they came
  const std::string answer = raw("");
  EXPECT_THAT(answer, ::testing::StartsWith("HTTP/1.1 503"));
  EXPECT_THAT(answer, ::testing::HasSubstr("Retry-After: 1"));
  EXPECT_THAT(answer, ::testing::HasSubstr("X-Request-Id: "));
  wait_for_figure("roadfix_requests_total{method=\"-\",route=\"-\",status=\"503\"} 1\n");
  go_ = true;
}

}  // namespace
}  // namespace roadfix::http
