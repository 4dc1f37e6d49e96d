#include "server/http/access_log.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/code_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roadfix::http {
namespace {

TEST(AccessLog, WritesOneValidJsonObjectForEachRequestWhateverTheClientSends) {
  const roadfix::testing::TemporaryFolder folder;
  AccessLog log((folder / "access.log").string());
  log.write({std::chrono::system_clock::time_point(std::chrono::milliseconds(1'700'000'000'123)), "id-1", "127.0.0.1",
             "GET", "/v1/maps?x=\"\n\x01\xff\\", "/v1/maps", 400, 12, 0.25});
  std::ifstream file(folder / "access.log");
  std::string line;
  ASSERT_TRUE(std::getline(file, line));
  const auto json = nlohmann::json::parse(line);
  EXPECT_EQ(json["time"], "2023-11-14T22:13:20.123Z");
  EXPECT_EQ(json["status"], 400);
  EXPECT_EQ(json["route"], "/v1/maps");
  EXPECT_FALSE(json.contains("problem"));
  EXPECT_FALSE(json.contains("answer"));
  EXPECT_FALSE(std::getline(file, line));
}

TEST(AccessLog, SaysWhatWasAnsweredOrWhyNothingWas) {
  AccessRecord record;
  record.answer = "no_fix";
  EXPECT_EQ(nlohmann::json::parse(json_line(record))["answer"], "no_fix");
  record = {};
  record.problem = "body-too-large";
  EXPECT_EQ(nlohmann::json::parse(json_line(record))["problem"], "body-too-large");
}

TEST(AccessLog, SaysWhenTheFileCannotBeWritten) {
  EXPECT_EQ(roadfix::testing::code_of([] { AccessLog("/proc/no/such/access.log"); }), "access-log");
}

}  // namespace
}  // namespace roadfix::http
