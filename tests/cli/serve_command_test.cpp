#include <gmock/gmock.h>

#include <fstream>
#include <string>
#include <vector>

#include "tests/e2e/child_process.hpp"
#include "tests/e2e/service_fixture.hpp"
#include "tests/support/eventually.hpp"

namespace roadfix {
namespace {

using nlohmann::json;
using testing::eventually;

TEST(ServeCommand, TakesOptionsFromTheEnvironmentAndAFile) {
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

TEST(ServeCommand, AnswersToItsOwnNamesAlone) {
  const testing::TemporaryFolder folder;
  for (const char* listens : {"127.0.0.1", "0.0.0.0"}) {
    const testing::ServiceProcess service(folder.path(),
                                          {"--host", listens, "--server-name", "maps.example.org,roadfix.lan"});
    httplib::Client client = testing::client_of(service);
    const auto status = [&](const char* host) {
      return client.Get("/v1/tracks", httplib::Headers{{"Host", host}})->status;
    };
    EXPECT_EQ(status("localhost:8080"), 200) << listens;
    EXPECT_EQ(status("roadfix.lan"), 200) << listens;
    EXPECT_EQ(status("evil.example"), 421) << listens;
  }
}

TEST(ServeCommand, SaysWhichSettingCannotBeUsed) {
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

TEST(ServeCommand, ListsTracksOfOneClientBehindAProxyToNoOther) {
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

TEST(ServeCommand, WritesALineForEachRequest) {
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

TEST(ServeCommand, WritesWhatAFixAndAStepWereAnswered) {
  const testing::TemporaryFolder folder;
  const testing::Town town;
  testing::write_map_file(folder / "town.gpkg", town.roads, 2.0);
  const std::string log = (folder / "access.log").string();
  const testing::ServiceProcess service(folder.path(), {"--access-log", log});
  httplib::Client client = testing::client_of(service);
  client.Post("/v1/maps/town/fix?cell_m=2", town.seen(), "image/png");
  const json track{{"map", "town"}, {"particles", 200}};
  const std::string id = testing::json_of(client.Post("/v1/tracks", track.dump(), "application/json"))["id"];
  client.Post("/v1/tracks/" + id + "/steps", R"({"sequence": 0, "time_us": 1})", "application/json");
  std::vector<json> entries;
  EXPECT_TRUE(eventually([&] {
    entries.clear();
    std::ifstream file(log);
    for (std::string line; std::getline(file, line) && !file.eof();) entries.push_back(json::parse(line));
    return entries.size() == 3;
  }));
  EXPECT_EQ(entries[0]["answer"], "fix");
  EXPECT_FALSE(entries[1].contains("answer"));
  EXPECT_EQ(entries[2]["answer"], "searching");
}

}  // namespace
}  // namespace roadfix
