#include "cli/fly/service_connection.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "tests/support/code_of.hpp"

namespace roadfix::fly {
namespace {

using testing::code_of;
using testing::message_of;

/// What becomes of a request that is answered so, and then well; `asked` counts.
class ServiceConnections : public ::testing::Test {
 protected:
  nlohmann::json asked_for(std::optional<http::Answer> first) {
    ServicePlan plan;
    plan.base = "http://127.0.0.1:1";
    plan.patience = patience;
    asked = 0;
    return ServiceConnection(plan).ask([&](http::Client&) {
      return ++asked == 1 ? first : http::Answer{200, "[7]", {}};
    });
  }

  std::chrono::seconds patience{60};
  int asked = 0;
};

TEST_F(ServiceConnections, AskAgainWhereThereIsNoAnswerOrOneThatMayPass) {
  EXPECT_EQ(asked_for(std::nullopt)[0], 7);
  EXPECT_EQ(asked, 2);
  for (const int status : {408, 429, 502, 503, 504}) {
    EXPECT_EQ(asked_for(http::Answer{status, "", {}})[0], 7);
    EXPECT_EQ(asked, 2) << status;
  }
}

TEST_F(ServiceConnections, TakeAllOtherRefusalsForGood) {
  for (const int status : {400, 404, 409, 410, 413, 422, 500}) {
    EXPECT_EQ(code_of([&] { asked_for(http::Answer{status, "", {}}); }), "service-refused");
    EXPECT_EQ(asked, 1) << status;
  }
}

TEST_F(ServiceConnections, TellOfARefusalOfAnotherServiceWhatIsTextInIt) {
  const auto refused = [&](const char* body) { return message_of([&] { asked_for(http::Answer{403, body, {}}); }); };
  EXPECT_EQ(refused(R"({"code":"map-locked","detail":"not now"})"), "the service refused: 403 map-locked: not now");
  EXPECT_EQ(refused(R"({"code":7,"detail":["not","now"]})"), "the service refused: 403 ?: ?");
  EXPECT_EQ(refused("[7]"), "the service refused: 403");
}

TEST_F(ServiceConnections, GiveUpWhenPatienceIsAtItsEnd) {
  patience = std::chrono::seconds(0);
  EXPECT_EQ(code_of([&] { asked_for(http::Answer{429, "", {}}); }), "service-silent");
}

}  // namespace
}  // namespace roadfix::fly
