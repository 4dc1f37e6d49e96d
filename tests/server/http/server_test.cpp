// What a client gets from the server.
#include <gmock/gmock.h>

#include <array>
#include <string>
#include <thread>
#include <vector>

#include "tests/server/http/server_fixture.hpp"
#include "tests/support/code_of.hpp"

namespace roadfix::http {
namespace {

using namespace std::chrono_literals;
using testing::eventually;

class HttpServer : public testing::HttpServerTest {};

/// A connection on which nothing comes while others wait for its thread is closed, also when a request is on its way,
/// and a heavy one that would hold a thread of the last ones is sent away: clients ask again (RFC 9112, section 9.3.1;
/// RFC 9110, section 15.6.4).
template <typename Ask>
httplib::Result answer_to(const Ask& ask) {
  httplib::Result answer = ask();
  for (int tries = 1; (!answer || answer->status == 503) && tries < 1000; ++tries) {
    std::this_thread::sleep_for(1ms);
    answer = ask();
  }
  return answer;
}

std::string told(const httplib::Result& answer) {
  return answer ? std::to_string(answer->status) + " " + answer->body : to_string(answer.error());
}

TEST_F(HttpServer, AnswersManyClientsAtOnceEachWithItsOwn) {
  const auto server = started();
  std::array<std::vector<std::string>, 16> expected, answers;
  {
    std::vector<std::jthread> clients;
    for (std::size_t i = 0; i < answers.size(); ++i) {
      clients.emplace_back([&, i] {
        httplib::Client c = client();
        for (std::size_t k = 0; k < 50; ++k) {
          const std::string text = std::to_string(i * 1000 + k);
          const std::string body(i * 100 + k, 'x');
          expected[i].push_back("200 " + text);
          answers[i].push_back(told(answer_to([&] { return c.Get("/echo?text=" + text); })));
          expected[i].push_back("200 " + std::to_string(body.size()));
          answers[i].push_back(told(answer_to([&] { return c.Post("/length", body, "text/plain"); })));
        }
      });
    }
  }
  EXPECT_EQ(answers, expected);
  EXPECT_EQ(metrics_.in_flight, 0);
}

TEST_F(HttpServer, FinishesWhatHasBegunWhenItStops) {
  auto server = started();
  std::string answer;
  std::jthread caller([&] {
    const auto result = client().Post("/wait", "", "text/plain");
    if (result) answer = result->body;
  });
  EXPECT_TRUE(eventually([&] { return waiting_ > 0; }));
  std::jthread stopper([&] { server->stop(); });
  EXPECT_TRUE(eventually([&] { return !client().Get("/echo"); })) << "it takes nothing new";
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

TEST_F(HttpServer, KnowsClientsOfIpv4AsSuchAlsoOnASocketForBothKinds) {
  router_.add({"GET", "/me", {}, Load::kLight, [](const Request& request) {
                 return Response{200, "text/plain", request.client};
               }});
  settings_.host = "::";
  std::unique_ptr<Server> server;
  try {
    server = started();
  } catch (const IoFailure&) {
    GTEST_SKIP() << "this machine has no IPv6";
  }
  EXPECT_EQ(client().Get("/me")->body, "127.0.0.1");
  httplib::Client other("::1", port_);
  const auto answer = other.Get("/me");
  if (answer) {
    EXPECT_EQ(answer->body, "::1");
  }
}

TEST_F(HttpServer, StreamsPiecesAndCutsOffAStreamThatFails) {
  const auto server = started();
  EXPECT_EQ(client().Get("/stream")->body, "piece piece piece ");
  EXPECT_FALSE(client().Get("/broken-stream")) << "not taken for whole";
  EXPECT_EQ(client().Get("/echo?text=alive")->body, "alive");
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

TEST_F(HttpServer, SaysToClientsOfHttp10ThatItCloses) {
  const auto server = started();
  for (const char* asked : {"", "Connection: keep-alive\r\n"}) {
    const std::string answer = raw(std::string("GET /echo?text=abc HTTP/1.0\r\n") + asked + "\r\n");
    EXPECT_THAT(answer, ::testing::StartsWith("HTTP/1.1 200"));
    EXPECT_THAT(answer, ::testing::HasSubstr("Connection: close"));
    EXPECT_THAT(answer, ::testing::Not(::testing::HasSubstr("Keep-Alive"))) << "and yet it is closed";
  }
}

TEST_F(HttpServer, ClosesForWhoeverAsksForItInAnyCaseAndAmongOthers) {
  const auto server = started();
  for (const char* asked : {"close", "Close", "TE, close", "CLOSE , TE"}) {
    testing::RawConnection connection(port_);
    connection.send(std::string("GET /echo?text=abc HTTP/1.1\r\nHost: x\r\nConnection: ") + asked + "\r\n\r\n");
    const auto start = Clock::now();
    EXPECT_THAT(connection.read_all(), ::testing::HasSubstr("Connection: close")) << asked;
    EXPECT_LT(Clock::now() - start, settings_.idle_time / 2) << asked << ": kept until it was idle for too long";
  }
  testing::RawConnection kept(port_);
  kept.send("GET /echo?text=abc HTTP/1.1\r\nHost: x\r\nConnection: closed\r\n\r\n");
  kept.finish();
  EXPECT_THAT(kept.read_all(), ::testing::HasSubstr("Keep-Alive"));
}

TEST_F(HttpServer, TellsALongTargetFromWhatIsNoRequest) {
  const auto server = started();
  // The library stops at 8192 by itself, and says nothing of a line beyond what a whole head may have.
  for (const std::size_t length : {std::size_t{5'000}, std::size_t{20'000}, std::size_t{300'000}}) {
    EXPECT_THAT(raw("GET /" + std::string(length, 'x') + " HTTP/1.1\r\nHost: x\r\n\r\n"),
                ::testing::HasSubstr("url-too-long"))
        << length;
  }
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

TEST_F(HttpServer, TellsCachesOfEveryAnswerThatItMayPack) {
  for (const char* type : {"text/javascript", "application/json", "image/png"}) {
    router_.add({"GET", std::string("/") + type, {}, Load::kLight, [type](const Request&) {
                   return Response{200, type, std::string(2000, 'x')};
                 }});
  }
  const auto server = started();
  for (const auto& [type, is_packed] :
       {std::pair{"text/javascript", true}, {"application/json", true}, {"image/png", false}}) {
    const auto answer = client().Get(std::string("/") + type, httplib::Headers{{"Accept-Encoding", "gzip"}});
    EXPECT_EQ(answer->has_header("Content-Encoding"), is_packed) << type;
    EXPECT_EQ(answer->get_header_value("Vary"), is_packed ? "Accept-Encoding" : "") << type;
  }
}

TEST_F(HttpServer, SendsAnswersWholeAndSaysThatARangeCannotBeRead) {
  const auto server = started();
  const auto with_range = [&](const std::string& range) {
    return raw("GET /echo?text=abc HTTP/1.1\r\nHost: x\r\nConnection: close\r\nRange: " + range + "\r\n\r\n");
  };
  EXPECT_THAT(with_range("bytes=0-1"), ::testing::EndsWith("\r\n\r\nabc"));
  for (const char* range : {"bytes=abc", "items=0-1"}) {
    EXPECT_THAT(with_range(range), ::testing::EndsWith("\r\n\r\nbad-header")) << range;
  }
}

TEST_F(HttpServer, RefusesHeaderNamesThatOthersReadDifferently) {
  const auto server = started();
  EXPECT_THAT(raw("POST /length HTTP/1.1\r\nHost: x\r\nContent-Length: 1\r\nTransfer-Encoding : chunked\r\n\r\nx"),
              ::testing::HasSubstr("bad-header"));
  EXPECT_THAT(raw("GET /echo HTTP/1.1\r\nHost: x\r\nX-A: b\r\n folded: c\r\n\r\n"), ::testing::HasSubstr("bad-header"));
}

TEST_F(HttpServer, TakesAWholeUrlAndItsHostAsClientsOfAProxySendIt) {
  router_.add({"GET", "/host", {}, Load::kLight, [](const Request& request) {
                 return Response{200, "text/plain", "<" + request.header("host") + ">"};
               }});
  const auto server = started();
  const std::string rest = " HTTP/1.1\r\nHost: x\r\nConnection: close\r\n";
  EXPECT_THAT(raw("GET http://maps.example:80/echo?text=abc" + rest + "\r\n"), ::testing::EndsWith("abc"));
  EXPECT_THAT(raw("GET http://maps.example:80/host" + rest + "\r\n"), ::testing::EndsWith("<maps.example:80>"));
  EXPECT_THAT(raw("POST http://x/length" + rest + "Content-Length: 2\r\n\r\nab"), ::testing::EndsWith("2"));
}

TEST_F(HttpServer, RefusesRequestsWithoutAHostOrWithTwo) {
  const auto server = started();
  const std::string line = "GET /echo?text=abc HTTP/1.1\r\nConnection: close\r\n";
  EXPECT_THAT(raw(line + "Host: x\r\n\r\n"), ::testing::StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(raw(line + "\r\n"), ::testing::HasSubstr("bad-header"));
  EXPECT_THAT(raw(line + "Host: x\r\nhost: y\r\n\r\n"), ::testing::HasSubstr("bad-header"));
  EXPECT_THAT(raw("GET /echo?text=abc HTTP/1.0\r\n\r\n"), ::testing::StartsWith("HTTP/1.1 200"));
}

TEST_F(HttpServer, SaysWhenItsAddressIsTaken) {
  const auto server = started();
  settings_.port = port_;
  Metrics metrics;
  Server second(settings_, router_, testing::plain_error, metrics);
  EXPECT_EQ(roadfix::testing::code_of([&] { second.start(); }), "address-not-available");
}

TEST_F(HttpServer, CanBeStoppedBeforeItStarted) {
  Server server(settings_, router_, testing::plain_error, metrics_);
  EXPECT_NO_THROW(server.stop());
}

}  // namespace
}  // namespace roadfix::http
