#include "server/api/problem.hpp"

#include <gtest/gtest.h>

#include <new>
#include <nlohmann/json.hpp>
#include <system_error>

#include "server/http/errors.hpp"

namespace roadfix::api {
namespace {

http::Response of(const auto& error) { return problem(std::make_exception_ptr(error)); }
nlohmann::json body(const http::Response& response) { return nlohmann::json::parse(response.body); }

TEST(Problem, GivesEachClassOfErrorsItsStatus) {
  EXPECT_EQ(status_of(http::InvalidField("x-y", "lat", "m")), 400);
  EXPECT_EQ(status_of(InvalidInput("prior-outside-map", "m")), 422);
  EXPECT_EQ(status_of(NotFound("map-not-found", "m")), 404);
  EXPECT_EQ(status_of(LimitExceeded("search-area-too-large", "m")), 413);
  EXPECT_EQ(status_of(LimitExceeded("too-many-tracks", "m")), 429);
  EXPECT_EQ(status_of(Interrupted("time-limit", "m")), 503);
  EXPECT_EQ(status_of(InUse("map-busy", "m")), 503);
  EXPECT_EQ(status_of(CorruptData("tile-corrupt", "m")), 500);
  EXPECT_EQ(status_of(IoFailure("disk-full", "m")), 500);
  EXPECT_EQ(status_of(IoFailure("map-unreadable", "m")), 503);
  EXPECT_EQ(status_of(InvalidInput("unsupported-media-type", "m")), 415);
}

TEST(Problem, IsThatOfTheServiceWhereWhatItKeptOfATrackIsDamaged) {
  EXPECT_EQ(status_of(CorruptData("track-store-corrupt", "m")), 503);
}

TEST(Problem, CarriesCodeDetailFieldAndByte) {
  const auto response = of(http::InvalidField("bad-json", "body", "it breaks off", 17));
  EXPECT_EQ(response.content_type, "application/problem+json");
  EXPECT_EQ(body(response), (nlohmann::json{{"type", "urn:roadfix:problem:bad-json"},
                                            {"title", "Bad request"},
                                            {"status", 400},
                                            {"code", "bad-json"},
                                            {"detail", "it breaks off"},
                                            {"field", "body"},
                                            {"byte", 17}}));
}

TEST(Problem, SaysWhatIsAllowedAndWhenToComeBack) {
  EXPECT_EQ(of(http::MethodNotAllowed("PUT", "GET, HEAD")).headers, (http::Parameters{{"Allow", "GET, HEAD"}}));
  EXPECT_EQ(of(http::Busy("full", std::chrono::seconds(3))).headers, (http::Parameters{{"Retry-After", "3"}}));
  EXPECT_EQ(of(Interrupted("time-limit", "m")).headers.at(0).first, "Retry-After");
}

TEST(Problem, KeepsTheTextOfUnexpectedErrorsFromTheClient) {
  const auto response = of(std::runtime_error("secret path"));
  EXPECT_EQ(response.status, 500);
  EXPECT_EQ(body(response)["code"], "internal-error");
  EXPECT_EQ(response.body.find("secret"), std::string::npos);
  EXPECT_EQ(of(std::bad_alloc()).status, 503);
}

TEST(Problem, OfMissingMemoryLooksLikeTheOthers) {
  const auto response = of(std::bad_alloc());
  const auto other = of(http::Busy("there is not enough memory for this request now", std::chrono::seconds(5)));
  EXPECT_EQ(response.status, other.status);
  EXPECT_EQ(response.content_type, other.content_type);
  EXPECT_EQ(response.headers, other.headers);
  EXPECT_EQ(response.body, other.body);
  EXPECT_EQ(response.problem, other.problem);
}

TEST(Problem, SaysThatThreadsAreShortAndWhenToComeBack) {
  const auto no_thread = of(std::system_error(std::make_error_code(std::errc::resource_unavailable_try_again)));
  EXPECT_EQ(no_thread.status, 503);
  EXPECT_EQ(no_thread.headers, (http::Parameters{{"Retry-After", "5"}}));
  EXPECT_NE(no_thread.body.find("threads"), std::string::npos);
  EXPECT_EQ(of(std::system_error(std::make_error_code(std::errc::io_error))).status, 500);
}

TEST(Problem, IsValidJsonWhateverBytesTheMessageHolds) {
  EXPECT_NO_THROW(body(of(NotFound("map-not-found", "\xff\xfe\n\""))));
}

}  // namespace
}  // namespace roadfix::api
