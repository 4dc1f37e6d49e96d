// Which searches run when: those of flights beside all others, whose clients may hang up.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <optional>
#include <string>

#include "tests/server/http/server_fixture.hpp"

namespace roadfix::http {
namespace {

using namespace std::chrono_literals;
using testing::eventually;

class HttpServerTurns : public testing::HttpServerTest {};

TEST_F(HttpServerTurns, CountsTheTimeOfAHeavyRequestFromItsTurnOn) {
  settings_.heavy_running = 1;
  settings_.request_time = 10min;
  settings_.turn_time = 20min;
  const auto server = started();
  Clock::time_point released;
  {
    std::jthread first([&] { client().Post("/wait", "", "text/plain"); });
    EXPECT_TRUE(eventually([&] { return waiting_ > 0; }));
    std::jthread second([&] { client().Post("/times", "", "text/plain"); });
    wait_for_figure("roadfix_heavy_waiting 1");
    released = Clock::now();
    go_ = true;
  }
  EXPECT_LE(received_.load(), released);
  EXPECT_GE(deadline_.load(), released + settings_.request_time);
}

TEST_F(HttpServerTurns, LetsARequestWaitForOthersWithoutATurnThatTheyMayNeed) {
  settings_.heavy_running = 1;
  settings_.turn_time = 1s;
  router_.add({"POST", "/dependent", {}, Load::kHeavy, {}, [this](const Request& request) {
                 ++waiting_;
                 while (!go_) std::this_thread::sleep_for(1ms);
                 return [read = request.body] { return Response{200, "text/plain", read + " done"}; };
               }});
  const auto server = started();
  std::jthread dependent([&] { EXPECT_EQ(client().Post("/dependent", "it", "text/plain")->body, "it done"); });
  EXPECT_TRUE(eventually([&] { return waiting_ > 0; }));
  EXPECT_EQ(client().Post("/length", "abc", "text/plain")->body, "3");
  go_ = true;
}

TEST_F(HttpServerTurns, LetsNoRequestWaitForATurnThatIsAnsweredWithoutOne) {
  settings_.heavy_running = 1;
  settings_.turn_time = 10min;
  router_.add({"POST", "/known", {}, Load::kHeavy, {}, [](const Request&) -> Prepared {
                 return Response{200, "text/plain", "known"};
               }});
  const auto server = started();
  const std::jthread first([&] { client().Post("/wait", "", "text/plain"); });
  EXPECT_TRUE(eventually([&] { return waiting_ > 0; }));
  EXPECT_EQ(client().Post("/known", "", "text/plain")->body, "known");
  go_ = true;
}

constexpr const char* kEmptyPost = " HTTP/1.1\r\nHost: x\r\nContent-Length: 0\r\n\r\n";

TEST_F(HttpServerTurns, GivesUpAnswersWhoseClientsHungUpWhetherTheyRunOrWait) {
  settings_.heavy_running = 1;
  settings_.turn_time = 10min;
  const auto server = started();
  {
    testing::RawConnection running(port_);
    running.send("POST /answer" + std::string(kEmptyPost));
    EXPECT_TRUE(eventually([&] { return waiting_ > 0; }));
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

TEST_F(HttpServerTurns, DoesWhatIsMoreThanAnAnswerThoughItsClientHungUp) {
  settings_.heavy_running = 1;
  settings_.turn_time = 10min;
  const auto server = started();
  const std::jthread first([&] { client().Post("/step", "", "text/plain"); });
  EXPECT_TRUE(eventually([&] { return waiting_ > 0; }));
  {
    testing::RawConnection queued(port_);
    queued.send("POST /step" + std::string(kEmptyPost));
    wait_for_figure("roadfix_live_waiting 1");
  }
  std::this_thread::sleep_for(300ms);
  go_ = true;
  wait_for_figure(R"(route="/step",status="200"} 2)");
}

TEST_F(HttpServerTurns, LetsNoFlightWaitForTheTurnsOfSearches) {
  settings_.heavy_running = 1;
  settings_.turn_time = 10min;
  const auto server = started();
  testing::RawConnection search(port_);
  search.send("POST /answer" + std::string(kEmptyPost));
  EXPECT_TRUE(eventually([&] { return waiting_ > 0; }));
  go_ = true;
  EXPECT_EQ(client().Post("/step", "", "text/plain")->body, "waited");
  wait_for_figure("roadfix_heavy_running 1");
}

TEST_F(HttpServerTurns, GivesFlightsTheProcessorsBeforeSearches) {
  const auto nice = [](const Request&) {
    return Response{200, "text/plain", std::to_string(getpriority(PRIO_PROCESS, static_cast<id_t>(gettid())))};
  };
  router_.add({"POST", "/search", {}, Load::kHeavy, nice});
  router_.add({"POST", "/live", {}, Load::kLive, nice});
  const auto server = started();
  const auto nice_of = [&](const char* path) { return std::stoi(client().Post(path, "", "text/plain")->body); };
  const int flight = nice_of("/live");
  EXPECT_GE(nice_of("/search"), std::min(flight + 5, 19));
  EXPECT_EQ(nice_of("/live"), flight);
}

TEST_F(HttpServerTurns, SendsAwayWhatHasWaitedTooLongForItsTurn) {
  settings_.heavy_running = 1;
  settings_.request_time = 10min;
  settings_.turn_time = 1ms;
  const auto server = started();
  std::jthread first([&] { client().Post("/wait", "", "text/plain"); });
  EXPECT_TRUE(eventually([&] { return waiting_ > 0; }));
  const auto answer = client().Post("/times", "", "text/plain");
  go_ = true;
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 503);
  EXPECT_EQ(answer->body, "server-busy");
}

}  // namespace
}  // namespace roadfix::http
