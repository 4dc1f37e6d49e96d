// The service over time: maps that come and go, many clients, the end.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/wait.h>

#include <atomic>
#include <fstream>
#include <thread>

#include "core/locate/calibration.hpp"
#include "core/units/error.hpp"
#include "server/api/web_mercator.hpp"
#include "tests/e2e/child_process.hpp"
#include "tests/e2e/service_fixture.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/raw_http.hpp"
#include "tests/support/sqlite_file.hpp"
#include "tests/tiles/store/map_fixture.hpp"

namespace roadfix {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using testing::eventually;

bool refuses_connections(int port) {
  try {
    const testing::RawConnection connection(port);
    return false;
  } catch (const std::system_error&) {
    return true;
  }
}

TEST(ServiceLife, NoticesMapsThatAppearChangeBreakAndLeave) {
  const testing::TemporaryFolder folder;
  const testing::ServiceProcess service(folder.path());
  httplib::Client client = testing::client_of(service);
  const testing::Town town;
  const auto status = [&] {
    const json maps = testing::json_of(client.Get("/v1/maps"))["maps"];
    return maps.empty() ? "none" : maps[0]["status"].get<std::string>();
  };
  EXPECT_EQ(status(), "none");

  testing::write_map_file(folder / "town.gpkg", town.roads, 2.0);
  EXPECT_TRUE(eventually([&] { return status() == "ready"; }));
  const std::string version = testing::json_of(client.Get("/v1/maps/town"))["version"];
  const auto tiles = [&] { return testing::json_of(client.Get("/v1/maps/town/tilejson.json"))["tiles"]; };
  const json tiles_before = tiles();

  {
    MapWriter writer(folder / "town.gpkg", {town.zone, 2.0});
    writer.remove_source("town");
  }
  EXPECT_TRUE(eventually([&] { return testing::json_of(client.Get("/v1/maps/town"))["version"] != version; }));
  EXPECT_NE(tiles(), tiles_before) << "a client that keeps tiles gets new ones by their new addresses";

  std::ofstream(folder / "broken.gpkg") << "no map at all";
  EXPECT_TRUE(eventually([&] { return status() == "unreadable"; })) << "the broken one is listed, first by name";
  EXPECT_EQ(testing::refusal(client.Get("/v1/maps/broken")), "503 map-unreadable");
  EXPECT_EQ(client.Get("/v1/maps/town")->status, 200) << "the other one is served";

  std::filesystem::remove(folder / "broken.gpkg");
  std::filesystem::remove(folder / "town.gpkg");
  EXPECT_TRUE(eventually([&] { return status() == "none"; }));
}

TEST(ServiceLife, AMapWithoutLatitudeAndLongitudeHidesNoOther) {
  const testing::TemporaryFolder folder;
  const testing::Town town;
  testing::write_map_file(folder / "far.gpkg", town.roads, 2.0);
  testing::write_map_file(folder / "town.gpkg", town.roads, 2.0);
  testing::open_sqlite(folder / "far.gpkg").execute("UPDATE gpkg_contents SET max_x = 1.04e6");
  const testing::ServiceProcess service(folder.path());
  httplib::Client client = testing::client_of(service);
  const json maps = testing::json_of(client.Get("/v1/maps"))["maps"];
  ASSERT_EQ(maps.size(), 2U);
  EXPECT_EQ(maps[0]["status"], "unreadable");
  EXPECT_EQ(maps[0]["code"], "position-outside-zone");
  EXPECT_EQ(maps[1]["status"], "ready");
}

TEST(ServiceLife, DescribesTilesAcrossThe180thMeridianWithinTheBoundsOfTileJson) {
  const testing::TemporaryFolder folder;
  const auto zone = UtmZone::from_epsg(32760).value();
  // 820 km east and 8140 km north are 16.8 degrees south on the 180th meridian.
  testing::write_map_file(folder / "taveuni.gpkg", testing::street_map(41, {2.0, {409'850, -4'070'150}, 300, 300}), 2.0,
                          zone);
  const testing::ServiceProcess service(folder.path());
  httplib::Client client = testing::client_of(service);
  const json bbox = testing::json_of(client.Get("/v1/maps/taveuni"))["bbox"];
  ASSERT_LT(bbox[0], 180.0);
  ASSERT_GT(bbox[2], 180.0);
  for (const char* path : {"/v1/maps/taveuni/tilejson.json", "/v1/maps/taveuni/localizability/tilejson.json"}) {
    const json tiles = testing::json_of(client.Get(path));
    EXPECT_EQ(tiles["bounds"], json({-180.0, bbox[1], 180.0, bbox[3]})) << path;
  }
  const json centre = testing::json_of(client.Get("/v1/maps/taveuni/tilejson.json"))["center"];
  EXPECT_LE(std::abs(centre[0].get<double>()), 180.0);
  for (const int x : {0, (1 << 15) - 1}) {
    const int y = static_cast<int>(api::mercator_pixel({centre[1], 180.0}, 15).y / 256);
    EXPECT_EQ(client.Get(fmt::format("/v1/maps/taveuni/tiles/15/{}/{}.png", x, y))->status, 200) << x;
  }
}

TEST(ServiceLife, AnswersARequestInFlightWhenItIsAskedToStop) {
  const testing::TemporaryFolder folder;
  const testing::Town town;
  testing::write_map_file(folder / "town.gpkg", town.roads, 2.0);
  testing::ServiceProcess service(folder.path());
  const std::string body = town.seen();
  testing::RawConnection connection(service.port());
  connection.send("POST /v1/maps/town/fix?cell_m=2 HTTP/1.1\r\nHost: x\r\nContent-Type: image/png\r\nContent-Length: " +
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

/// A calibration that weighs nothing but the ground.
std::string calibration_by_ground(const testing::TemporaryFolder& folder, double weight, double sigma_scale = 1.0) {
  const std::filesystem::path path = folder / ("ground-" + std::to_string(weight) + ".json");
  json document{{"format", kCalibrationFormat},
                {"bias", 0.0},
                {"highest", 0.9},
                {"sigma_scale", {{"position", sigma_scale}, {"heading", 1.0}}}};
  for (const CountedFigure& figure : kCountedFigures) {
    document["terms"][figure.name] = {{"weight", figure.name == "ground" ? weight : 0.0}, {"most", 10.0}};
  }
  std::ofstream(path) << document;
  return path.string();
}

TEST(ServiceLife, IsAsSureAsTheCalibrationItIsGiven) {
  const testing::TemporaryFolder folder;
  const testing::Town town;
  testing::write_map_file(folder / "town.gpkg", town.roads, 2.0);
  const testing::ServiceProcess service(folder.path(),
                                        {"--calibration", calibration_by_ground(folder, 0.0), "--request-time", "600"});
  httplib::Client client = testing::client_of(service);
  const json fix = testing::json_of(client.Post("/v1/maps/town/fix?cell_m=2", town.seen(), "image/png"));
  EXPECT_EQ(fix["status"], "ambiguous") << fix;
  EXPECT_DOUBLE_EQ(fix["probability"].get<double>(), 0.5) << "of a logistic function that weighs nothing";
}

TEST(ServiceLife, SendsTilesOfLocalizabilityAnewUnderAnotherCalibration) {
  const testing::TemporaryFolder folder;
  testing::write_map_file(folder / "town.gpkg", testing::Town().roads, 2.0);
  const auto tag = [&](double weight, double sigma_scale) {
    const testing::ServiceProcess service(folder.path(),
                                          {"--calibration", calibration_by_ground(folder, weight, sigma_scale)});
    return testing::client_of(service).Get("/v1/maps/town/localizability/tiles/16/0/0.png")->get_header_value("ETag");
  };
  const std::string first = tag(0.2, 1.0);
  EXPECT_EQ(tag(0.2, 1.0), first);
  EXPECT_NE(tag(0.3, 1.0), first);
  EXPECT_NE(tag(0.2, 2.0), first);
}

TEST(ServiceLife, SendsTilesAnewWhenTheOverviewsOfAMapAreFused) {
  const testing::TemporaryFolder folder;
  MapWriter writer(folder / "city.gpkg", testing::settings_37n());
  const testing::TestSource source{"a", 1, testing::some_blocks(8)};
  for (const TileIndex block : writer.begin_source(source.record(), source.blocks, false)) {
    testing::put_block(writer, "a", block, testing::random_cells(source.seed, block));
  }
  std::stop_source stop;
  const auto stop_after_the_finest = [&](std::int64_t done, std::int64_t) {
    if (done > 0) stop.request_stop();
  };
  EXPECT_THROW(writer.finish_source("a", stop_after_the_finest, stop.get_token()), Interrupted);
  const testing::ServiceProcess service(folder.path());
  httplib::Client client = testing::client_of(service);
  const std::string tile = "/v1/maps/city/tiles/11/1241/791.png";
  const auto before = client.Get(tile);
  ASSERT_EQ(before->status, 204) << "what it shows is not fused yet";

  writer.finish_source("a");
  ASSERT_TRUE(eventually([&] { return testing::json_of(client.Get("/v1/maps/city"))["status"] == "ready"; }));
  const httplib::Headers known{{"If-None-Match", before->get_header_value("ETag")}};
  EXPECT_EQ(client.Get(tile, known)->status, 200);
}

TEST(ServiceLife, StopsAtOnceWhenNothingIsInFlight) {
  const testing::TemporaryFolder folder;
  testing::ServiceProcess service(folder.path());
  testing::RawConnection idle(service.port());
  httplib::Client client = testing::client_of(service);
  client.Get("/healthz");
  const auto start = std::chrono::steady_clock::now();
  service.send_signal(SIGINT);
  EXPECT_EQ(service.wait(), 0);
  EXPECT_LT(std::chrono::steady_clock::now() - start, 10s) << "idle connections, kept for 15 s, do not hold it up";
}

TEST(ServiceLife, SendsSearchesAwayWhenTooManyWait) {
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

TEST(ServiceLife, HoldsTheGroundOfFewWindowsAtATime) {
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

TEST(ServiceLife, EndsASearchWhoseClientHungUp) {
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
        "POST /v1/maps/town/fix?cell_m=2&scale_range=0.3&proof_s=600 HTTP/1.1\r\nHost: x\r\nContent-Type: "
        "image/png\r\nContent-Length: " +
        std::to_string(body.size()) + "\r\n\r\n" + body);
    EXPECT_TRUE(eventually([&] { return told("roadfix_heavy_running 1\n"); }));
  }
  EXPECT_TRUE(eventually([&] { return told(R"(route="/v1/maps/{map}/fix",status="499"} 1)"); }));
}

TEST(ServiceLife, ServesEveryClientThoughThereAreMoreThanThreads) {
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

TEST(ServiceLife, EndsARequestWhoseTimeIsOver) {
  const testing::TemporaryFolder folder;
  const testing::Town town;
  testing::write_map_file(folder / "town.gpkg", town.roads, 2.0);
  const testing::ServiceProcess service(folder.path(), {"--request-time", "0.001"});
  const auto answer = testing::client_of(service).Post("/v1/maps/town/fix?cell_m=2", town.seen(), "image/png");
  // Before the search it is a refusal, in the search an answer that says how far it came.
  if (answer->status != 503) {
    EXPECT_EQ(testing::json_of(answer)["reason"], "search-time-limit") << answer->body;
  }
}

TEST(ServiceLife, TakesOptionsFromTheEnvironmentAndAFile) {
  const testing::TemporaryFolder folder;
  std::ofstream(folder / "roadfix.conf") << "max-poses = 77\n";
  ::setenv("ROADFIX_MAX_SEARCH", "12.5", 1);
  const testing::ServiceProcess service(folder.path(),
                                        {"--config", (folder / "roadfix.conf").string(), "--max-cells", "555"});
  ::unsetenv("ROADFIX_MAX_SEARCH");
  const json limits = testing::json_of(testing::client_of(service).Get("/v1/limits"));
  EXPECT_EQ(limits["poses"], 77);
  EXPECT_EQ(limits["search_km2"], 12.5);
  EXPECT_EQ(limits["cells"], 555);
}

TEST(ServiceLife, SaysWhichSettingCannotBeUsed) {
  const testing::TemporaryFolder folder;
  std::ofstream(folder / "roadfix.conf") << "cors_origin = \"*\"\n";
  const auto refused = [&](const std::vector<std::string>& options) {
    std::vector<std::string> arguments{"serve", "--maps", folder.path().string(), "--port", "0"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const auto result = testing::run_child(ROADFIX_PROGRAM, arguments, folder.path());
    return std::to_string(result.code) + " " + result.err;
  };
  using ::testing::AllOf;
  using ::testing::HasSubstr;
  using ::testing::StartsWith;
  EXPECT_THAT(refused({"--request-time", "1e30"}),
              AllOf(StartsWith("2"), HasSubstr("--request-time: must be a number above 0")));
  EXPECT_THAT(refused({"--threads", "-1"}), AllOf(StartsWith("2"), HasSubstr("at most 10000, not -1")));
  EXPECT_THAT(refused({"--config", (folder / "roadfix.conf").string()}),
              AllOf(StartsWith("2"), HasSubstr("'cors_origin' is not an option of serve")));
  EXPECT_THAT(refused({"--cors-origin", "https://ops.example.org/"}),
              AllOf(StartsWith("1"), HasSubstr("bad-cors-origin")));
  EXPECT_THAT(refused({"--proxy", "nginx"}), AllOf(StartsWith("1"), HasSubstr("bad-proxy")));
  const auto no_room =
      AllOf(StartsWith("2"), HasSubstr("--body-memory: 32 MiB hold no body of the 64 MiB that --max-body"
                                       " allows: give 64 or more"));
  EXPECT_THAT(refused({"--body-memory", "32"}), no_room);
  std::ofstream(folder / "small.conf") << "body-memory = 32\n";
  EXPECT_THAT(refused({"--config", (folder / "small.conf").string()}), no_room);
  ::setenv("ROADFIX_MAX_BODY", "513", 1);
  EXPECT_THAT(refused({}), AllOf(StartsWith("2"), HasSubstr("512 MiB hold no body of the 513 MiB")));
  ::unsetenv("ROADFIX_MAX_BODY");
}

TEST(ServiceLife, ListsTracksOfOneClientBehindAProxyToNoOther) {
  const testing::TemporaryFolder folder;
  testing::write_map_file(folder / "town.gpkg", testing::Town().roads, 2.0);
  const testing::ServiceProcess service(folder.path(), {"--proxy", "10.0.0.0/8,127.0.0.1"});
  httplib::Client client = testing::client_of(service);
  const httplib::Headers one{{"X-Forwarded-For", "203.0.113.1"}};
  const httplib::Headers other{{"X-Forwarded-For", "203.0.113.2"}};
  ASSERT_EQ(client.Post("/v1/tracks", one, R"({"map":"town"})", "application/json")->status, 201);
  EXPECT_EQ(testing::json_of(client.Get("/v1/tracks", one))["tracks"].size(), 1U);
  EXPECT_EQ(testing::json_of(client.Get("/v1/tracks", other))["tracks"].size(), 0U);
}

TEST(ServiceLife, WritesALineForEachRequest) {
  const testing::TemporaryFolder folder;
  const std::string log = (folder / "access.log").string();
  const testing::ServiceProcess service(folder.path(), {"--access-log", log});
  testing::client_of(service).Get("/v1/maps?x=1", {{"X-Request-Id", "flight-7"}});
  std::string line;
  EXPECT_TRUE(eventually([&] {
    std::ifstream file(log);
    return static_cast<bool>(std::getline(file, line));
  }));
  const json entry = json::parse(line);
  EXPECT_EQ(entry["id"], "flight-7");
  EXPECT_EQ(entry["status"], 400);
  EXPECT_EQ(entry["route"], "/v1/maps");
  EXPECT_EQ(entry["problem"], "unknown-parameter");
}

}  // namespace
}  // namespace roadfix
