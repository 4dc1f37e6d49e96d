#include "server/http/client.hpp"

#include <gtest/gtest.h>

#include "core/units/error.hpp"
#include "server/http/errors.hpp"
#include "server/http/server.hpp"
#include "tests/support/code_of.hpp"

namespace roadfix::http {
namespace {

using namespace std::chrono_literals;
using roadfix::testing::code_of;

Response refusal(std::exception_ptr thrown, const Request&) {
  try {
    std::rethrow_exception(std::move(thrown));
  } catch (const Busy& busy) {
    return {503, "text/plain", busy.code(), {{"Retry-After", std::to_string(busy.retry_after().count())}}};
  } catch (const std::exception& error) {
    return {404, "text/plain", error.what()};
  }
}

class HttpClient : public ::testing::Test {
 protected:
  std::unique_ptr<Server> started(int port = 0) {
    Router router;
    router.add({"GET", "/echo", {"text"}, Load::kLight, [](const Request& request) {
                  return Response{200, "text/plain", request.query.at(0).second};
                }});
    router.add({"POST", "/length", {}, Load::kLight, [](const Request& request) {
                  return Response{201, "text/plain", request.media_type() + " " + std::to_string(request.body.size())};
                }});
    router.add({"DELETE", "/thing", {}, Load::kLight, [](const Request&) { return Response{204, {}, {}}; }});
    router.add({"GET", "/busy", {}, Load::kLight, [](const Request&) -> Response { throw Busy("later", 7s); }});
    ServerSettings settings;
    settings.port = port;
    auto server = std::make_unique<Server>(settings, std::move(router), refusal, metrics_);
    port_ = server->start();
    return server;
  }
  std::string base() const { return "http://127.0.0.1:" + std::to_string(port_); }

  Metrics metrics_;
  int port_ = 0;
};

TEST_F(HttpClient, HandsOverWhatTheServiceAnswers) {
  const auto server = started();
  Client client(base() + "/", 600s);
  EXPECT_EQ(client.get("/echo?text=a%20b")->body, "a b");
  const auto posted = client.post("/length", std::string(100'000, 'x'), "image/png");
  EXPECT_EQ(posted->status, 201);
  EXPECT_EQ(posted->body, "image/png 100000");
  EXPECT_FALSE(posted->retry_after);
  EXPECT_EQ(client.remove("/thing")->status, 204);
  const auto busy = client.get("/busy");
  EXPECT_EQ(busy->status, 503);
  EXPECT_EQ(busy->retry_after, 7s);
  EXPECT_EQ(client.get("/nothing")->status, 404);
}

TEST_F(HttpClient, HasNoAnswerWhileNobodyListensAndOneAfterwards) {
  auto server = started();
  Client client(base(), 600s);
  EXPECT_TRUE(client.get("/echo?text=1"));
  const int port = port_;
  server->stop();
  server.reset();
  EXPECT_FALSE(client.get("/echo?text=2"));
  server = started(port);
  EXPECT_EQ(client.get("/echo?text=3")->body, "3");
}

TEST(HttpClientAddress, IsRefusedWhereItIsNone) {
  for (const char* base : {"", "127.0.0.1:8080", "https://here", "http://", "http://here:port", "http://here:0",
                           "http://here:99999", "http://here/there", "http://user@here", "http://:80"}) {
    EXPECT_EQ(code_of([&] { Client(base, 1s); }), "bad-url") << base;
  }
  for (const char* base : {"http://localhost", "http://localhost:80/", "http://[::1]:8080", "http://[::1]"}) {
    EXPECT_EQ(code_of([&] { Client(base, 1s); }), "no error") << base;
  }
}

}  // namespace
}  // namespace roadfix::http
