#include "server/handlers/answers.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temporary_folder.hpp"

namespace roadfix::server {
namespace {

namespace fs = std::filesystem;

TEST(BuildOf, TellsOneProgramFromAnotherInItsPlace) {
  const testing::TemporaryFolder folder;
  const fs::path program = folder / "roadfix";
  EXPECT_EQ(build_of(program), "");
  std::ofstream(program) << "first";
  const std::string first = build_of(program);
  EXPECT_EQ(build_of(program), first);
  const auto later_time = fs::last_write_time(program) + std::chrono::nanoseconds(1);
  fs::last_write_time(program, later_time);
  const std::string later = build_of(program);
  EXPECT_NE(later, first);
  std::ofstream(program, std::ios::app) << " and more";
  fs::last_write_time(program, later_time);
  EXPECT_NE(build_of(program), later);
}

TEST(BuildOf, KnowsTheProgramThatRuns) { EXPECT_NE(build_of("/proc/self/exe"), ""); }

}  // namespace
}  // namespace roadfix::server
