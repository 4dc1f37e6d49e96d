// The service under load, and its end: many clients, slow ones and gone ones, requests that take too long.
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/wait.h>

#include <atomic>
#include <fstream>
#include <thread>

#include "tests/e2e/service_fixture.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/raw_http.hpp"
#include "tests/tiles/store/map_fixture.hpp"

namespace roadfix {
namespace {

using namespace std::chrono_literals;
using testing::eventually;

bool refuses_connections(int port) {
  try {
    const testing::RawConnection connection(port);
    return false;
  } catch (const std::system_error&) {
    return true;
  }
}

TEST(ServiceLoad, AnswersARequestInFlightWhenItIsAskedToStop) {
  const testing::TemporaryFolder folder;
  const testing::Town town;
  testing::write_map_file(folder / "town.gpkg", town.roads, 2.0);
  testing::ServiceProcess service(folder.path());
  const std::string body = town.seen();
  testing::RawConnection connection(service.port());
  connection.send(
      "POST /v1/maps/town/fix?cell_m=2 HTTP/1.1\r\nHost: localhost\r\nContent-Type: image/png\r\nContent-Length: " +
      std::to_string(body.size()) + "\r\n\r\n" + body.substr(0, 100));
  httplib::Client client = testing::client_of(service);
  const auto has_a_thread = [&] {
    return client.Get("/metrics")->body.find("roadfix_connections 2\n") != std::string::npos;
  };
  ASSERT_TRUE(eventually(has_a_thread)) << "the request, and who asks for the metrics";
  service.send_signal(SIGTERM);
  EXPECT_TRUE(eventually([&] { return refuses_connections(service.port()); }));
  connection.send(body.substr(100));
  const std::string answer = connection.read_all(30s);
  EXPECT_THAT(answer, ::testing::StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(answer, ::testing::HasSubstr("\"status\":\"fix\""));
  const int status = service.wait();
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

TEST(ServiceLoad, EndsAtOnceAtTheSecondSignal) {
  const testing::TemporaryFolder folder;
  testing::ServiceProcess service(folder.path(), {"--body-time", "600"});
  testing::RawConnection slow(service.port());
  slow.send(
      "POST /v1/detect?gsd_m=1 HTTP/1.1\r\nHost: localhost\r\nContent-Type: image/png\r\nContent-Length: 9\r\n\r\n");
  httplib::Client client = testing::client_of(service);
  const auto has_a_thread = [&] {
    return client.Get("/metrics")->body.find("roadfix_connections 2\n") != std::string::npos;
  };
  ASSERT_TRUE(eventually(has_a_thread)) << "the request, and who asks for the metrics";
  service.send_signal(SIGTERM);
  service.send_signal(SIGINT);
  const int status = service.wait();
  ASSERT_TRUE(WIFEXITED(status)) << status;
  EXPECT_THAT(WEXITSTATUS(status), ::testing::AnyOf(128 + SIGTERM, 128 + SIGINT)) << "it did not wait for the body";
}

class ServiceStop : public ::testing::TestWithParam<int> {};

TEST_P(ServiceStop, IsAtOnceWhenNothingIsInFlight) {
  const testing::TemporaryFolder folder;
  testing::ServiceProcess service(folder.path());
  testing::RawConnection idle(service.port());
  httplib::Client client = testing::client_of(service);
  client.Get("/healthz");
  const auto start = std::chrono::steady_clock::now();
  service.send_signal(GetParam());
  EXPECT_EQ(service.wait(), 0);
  EXPECT_LT(std::chrono::steady_clock::now() - start, 10s) << "idle connections, kept for 15 s, do not hold it up";
}

INSTANTIATE_TEST_SUITE_P(Signals, ServiceStop, ::testing::Values(SIGINT, SIGHUP));

TEST(ServiceLoad, SendsSearchesAwayWhenTooManyWait) {
  const testing::TemporaryFolder folder;
  const testing::Town town;
  testing::write_map_file(folder / "town.gpkg", town.roads, 2.0);
  const testing::ServiceProcess service(folder.path(), {"--searches", "1", "--searches-waiting", "1"});
  const std::string body = town.seen();
  std::atomic<int> answered = 0;
  std::atomic<int> sent_away = 0;
  {
    std::vector<std::jthread> clients;
    for (int i = 0; i < 8; ++i) {
      clients.emplace_back([&] {
        httplib::Client client = testing::client_of(service);
        for (int k = 0; k < 4; ++k) {
          const auto answer = client.Post("/v1/maps/town/fix?cell_m=2", body, "image/png");
          if (answer && answer->status == 200) ++answered;
          if (testing::refusal(answer) == "503 server-busy" && !answer->get_header_value("Retry-After").empty())
            ++sent_away;
        }
      });
    }
  }
  EXPECT_EQ(answered + sent_away, 32);
  EXPECT_GT(answered, 0);
  EXPECT_GT(sent_away, 0);
}

/// The most that the process ever held.
double peak_mib(pid_t process) {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  for (std::string word; status >> word;) {
    double kib = 0.0;
    if (word == "VmHWM:" && status >> kib) return kib / 1024.0;
  }
  return 0.0;
}

TEST(ServiceLoad, HoldsTheGroundOfFewWindowsAtATime) {
  const testing::TemporaryFolder folder;
  {
    MapWriter writer(folder / "wide.gpkg", testing::settings_37n());
    testing::ingest(writer, {"corners", 1, {{847, -8165}, {887, -8125}}});
  }
  const testing::ServiceProcess service(folder.path(), {"--searches", "1"});
  const std::string window = "/v1/maps/wide/window?lat=37.67&lon=38.38&width_m=29000&height_m=10&heading_deg=45";
  httplib::Client first = testing::client_of(service);
  ASSERT_EQ(first.Get(window)->status, 200);
  const double of_one = peak_mib(service.id());
  ASSERT_GT(of_one, 100.0) << "the 110 million cells between the corners";
  std::atomic<int> answered = 0;
  std::vector<std::jthread> clients;
  for (int i = 0; i < 12; ++i) {
    clients.emplace_back([&] {
      httplib::Client client = testing::client_of(service);
      answered += client.Get(window)->status == 200 ? 1 : 0;
    });
  }
  clients.clear();
  EXPECT_EQ(answered, 12);
  EXPECT_LT(peak_mib(service.id()), of_one + 150.0);
}

TEST(ServiceLoad, EndsASearchWhoseClientHungUp) {
  const testing::TemporaryFolder folder;
  const testing::Town town;
  testing::write_map_file(folder / "town.gpkg", town.roads, 2.0);
  const testing::ServiceProcess service(folder.path(), {"--request-time", "1200"});
  const auto told = [&](const std::string& figure) {
    return testing::client_of(service).Get("/metrics")->body.find(figure) != std::string::npos;
  };
  const std::string body = town.seen_from(town.pose, 60);
  {
    testing::RawConnection connection(service.port());
    connection.send(
        "POST /v1/maps/town/fix?cell_m=2&scale_range=0.3&proof_s=600 HTTP/1.1\r\nHost: localhost\r\nContent-Type: "
        "image/png\r\nContent-Length: " +
        std::to_string(body.size()) + "\r\n\r\n" + body);
    EXPECT_TRUE(eventually([&] { return told("roadfix_heavy_running 1\n"); }));
  }
  EXPECT_TRUE(eventually([&] { return told(R"(route="/v1/maps/{map}/fix",status="499"} 1)"); }));
}

TEST(ServiceLoad, ServesEveryClientThoughThereAreMoreThanThreads) {
  const testing::TemporaryFolder folder;
  const testing::ServiceProcess service(folder.path(), {"--threads", "2"});
  std::vector<std::unique_ptr<testing::RawConnection>> idle;
  for (int i = 0; i < 4; ++i) idle.push_back(std::make_unique<testing::RawConnection>(service.port()));
  std::atomic<int> answered = 0;
  {
    std::vector<std::jthread> clients;
    for (int i = 0; i < 8; ++i) {
      clients.emplace_back([&] {
        httplib::Client client = testing::client_of(service);
        for (int k = 0; k < 100; ++k) {
          const auto answer = client.Get("/healthz");
          if (answer && answer->status == 200) ++answered;
        }
      });
    }
  }
  EXPECT_EQ(answered, 800) << "neither idle connections nor busy ones starve the others";
}

TEST(ServiceLoad, EndsARequestWhoseTimeIsOver) {
  const testing::TemporaryFolder folder;
  const testing::Town town;
  testing::write_map_file(folder / "town.gpkg", town.roads, 2.0);
  const testing::ServiceProcess service(folder.path(), {"--request-time", "0.001"});
  const auto answer = testing::client_of(service).Post("/v1/maps/town/fix?cell_m=2", town.seen(), "image/png");
  // Before the search it is a refusal, in the search an answer that says how far it came.
  if (answer->status == 503) {
    EXPECT_EQ(testing::refusal(answer), "503 request-deadline");
  } else {
    EXPECT_EQ(testing::json_of(answer)["reason"], "search-time-limit") << answer->body;
  }
}

}  // namespace
}  // namespace roadfix
