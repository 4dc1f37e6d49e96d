#include "core/units/memory.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <memory>
#include <vector>

namespace roadfix {
namespace {

double resident_mb() {
  std::ifstream statm("/proc/self/statm");
  long total = 0;
  long resident = 0;
  statm >> total >> resident;
  return static_cast<double>(resident * sysconf(_SC_PAGESIZE)) / 1e6;
}

using Blocks = std::vector<std::unique_ptr<std::vector<char>>>;

/// What is left of 100 MB of which 95 were freed.
Blocks few_of_many() {
  Blocks blocks;
  for (int i = 0; i < 1000; ++i) blocks.push_back(std::make_unique<std::vector<char>>(100'000, 'x'));
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (i % 20 != 19) blocks[i].reset();
  }
  return blocks;
}

class Memory : public ::testing::Test {
 protected:
  void SetUp() override {
#if !defined(__GLIBC__)
    GTEST_SKIP() << "another C library";
#endif
    if (ROADFIX_SANITIZED) GTEST_SKIP() << "a sanitizer keeps what was let go of";
    keep_freed_memory();
  }
};

TEST_F(Memory, GivesBackWhatIsFreedBetweenBlocksThatAreKept) {
  const double before_mb = resident_mb();
  const Blocks blocks = few_of_many();
  EXPECT_GT(resident_mb() - before_mb, 80.0) << "kept for the next request";
  give_back_freed_memory();
  EXPECT_LT(resident_mb() - before_mb, 20.0);
}

TEST_F(Memory, KeepsWhatIsFreedUpToABound) {
  const double before_mb = resident_mb();
  const Blocks blocks = few_of_many();
  give_back_freed_memory_beyond(200'000'000);
  EXPECT_GT(resident_mb() - before_mb, 80.0);
  give_back_freed_memory_beyond(80'000'000);
  EXPECT_LT(resident_mb() - before_mb, 20.0);
}

}  // namespace
}  // namespace roadfix
