#include "server/http/router.hpp"

#include <gmock/gmock.h>

#include "server/http/errors.hpp"

namespace roadfix::http {
namespace {

Router some_router() {
  Router router;
  router.add({"GET", "/v1/maps", {}, Load::kLight, {}});
  router.add({"GET", "/v1/maps/{map}/tiles/{z}/{x}/{y}.png", {"style"}, Load::kLight, {}});
  router.add({"POST", "/v1/maps/{map}/fix", {"lat"}, Load::kHeavy, {}});
  return router;
}

std::vector<std::string> segments(const std::string& path) { return parse_target(path).segments; }

TEST(Router, FillsPathParametersAndTakesSuffixesOff) {
  const Router router = some_router();
  const RouteMatch match = router.find("GET", segments("/v1/maps/city/tiles/3/4/5.png"));
  EXPECT_EQ(match.route->path, "/v1/maps/{map}/tiles/{z}/{x}/{y}.png");
  EXPECT_THAT(match.path_parameters,
              ::testing::UnorderedElementsAre(::testing::Pair("map", "city"), ::testing::Pair("z", "3"),
                                              ::testing::Pair("x", "4"), ::testing::Pair("y", "5")));
}

TEST(Router, AnswersHeadWhereItAnswersGet) {
  EXPECT_NE(some_router().find("HEAD", segments("/v1/maps")).route, nullptr);
}

TEST(Router, TellsAMissingPathFromAMissingMethod) {
  EXPECT_THROW(some_router().find("GET", segments("/v1/map")), NotFound);
  EXPECT_THROW(some_router().find("GET", segments("/v1/maps/city/tiles/3/4/.png")), NotFound);
  try {
    some_router().find("DELETE", segments("/v1/maps/city/fix"));
    FAIL();
  } catch (const MethodNotAllowed& error) {
    EXPECT_EQ(error.allowed(), "OPTIONS, POST");
  }
}

TEST(Router, RefusesUnknownAndRepeatedParametersByName) {
  const Router router = some_router();
  const Route& fix = *router.find("POST", segments("/v1/maps/city/fix")).route;
  EXPECT_NO_THROW(check_parameter_names(fix, {{"lat", "1"}}));
  try {
    check_parameter_names(fix, {{"lat", "1"}, {"latt", "1"}});
    FAIL();
  } catch (const InvalidField& error) {
    EXPECT_EQ(error.code(), "unknown-parameter");
    EXPECT_EQ(error.field(), "latt");
  }
  EXPECT_THROW(check_parameter_names(fix, {{"lat", "1"}, {"lat", "2"}}), InvalidField);
}

}  // namespace
}  // namespace roadfix::http
