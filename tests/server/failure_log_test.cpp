#include "server/failure_log.hpp"

#include <gtest/gtest.h>

#include <new>

#include "core/units/error.hpp"
#include "server/http/errors.hpp"

namespace roadfix::server {
namespace {

using namespace std::chrono_literals;

std::exception_ptr thrown(const auto& error) { return std::make_exception_ptr(error); }

TEST(FailureLog, NamesTheRequestWhoseFaultIsTheServices) {
  FailureLog log;
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(log.line(thrown(CorruptData("tile-corrupt", "tile 3/4 is damaged")), 500, "flight-7"),
              "request flight-7 failed: tile 3/4 is damaged [tile-corrupt]");
  }
  EXPECT_EQ(log.line(thrown(std::logic_error("a mistake")), 500, "flight-8"), "request flight-8 failed: a mistake");
}

TEST(FailureLog, TellsOfAFullDiskNowAndThen) {
  FailureLog log;
  const auto full = thrown(IoFailure("track-store-full", "no space left"));
  const FailureLog::Clock::time_point start{};
  EXPECT_EQ(log.line(full, 503, "a", start), "request a failed: no space left [track-store-full]");
  EXPECT_EQ(log.line(full, 503, "b", start + 1s), std::nullopt);
  EXPECT_EQ(log.line(full, 503, "c", start + 9s), std::nullopt);
  EXPECT_TRUE(log.line(thrown(IoFailure("map-unreadable", "cut off")), 503, "d", start + 9s)) << "another thing";
  EXPECT_EQ(log.line(full, 503, "e", start + 11s),
            "request e failed: no space left [track-store-full] (2 more like it before)");
  EXPECT_EQ(log.line(full, 503, "f", start + 30s), "request f failed: no space left [track-store-full]");
}

TEST(FailureLog, TellsOfAFileThatAnotherHoldsButNotOfWorkThatTookTooLong) {
  FailureLog log;
  EXPECT_EQ(log.line(thrown(InUse("track-store-busy", "stop it")), 503, "a"),
            "request a failed: stop it [track-store-busy]");
  EXPECT_EQ(log.line(thrown(Interrupted("request-deadline", "too long")), 503, "a"), std::nullopt);
}

TEST(FailureLog, TellsOfMissingMemoryNowAndThen) {
  FailureLog log;
  const FailureLog::Clock::time_point start{};
  EXPECT_EQ(log.line(thrown(std::bad_alloc()), 503, "a", start), "request a failed: std::bad_alloc");
  EXPECT_EQ(log.line(thrown(std::bad_alloc()), 503, "b", start + 9s), std::nullopt);
  EXPECT_EQ(log.line(thrown(std::bad_alloc()), 503, "c", start + 11s),
            "request c failed: std::bad_alloc (1 more like it before)");
}

TEST(FailureLog, LeavesOutWhatIsTheClientsOrOnlyTooMuch) {
  FailureLog log;
  EXPECT_EQ(log.line(thrown(InvalidInput("bad-url", "no")), 400, "a"), std::nullopt);
  EXPECT_EQ(log.line(thrown(http::Busy("too many", 1s)), 503, "a"), std::nullopt);
}

}  // namespace
}  // namespace roadfix::server
