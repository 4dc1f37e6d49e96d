#include "cli/open_files.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <vector>

namespace roadfix::cli {
namespace {

/// How many of `wanted` files can be open beside those that are.
int opened(int wanted) {
  std::vector<int> files;
  for (int file = 0; static_cast<int>(files.size()) < wanted && file >= 0;) {
    file = ::open("/dev/null", O_RDONLY);
    if (file >= 0) files.push_back(file);
  }
  for (const int file : files) ::close(file);
  return static_cast<int>(files.size());
}

TEST(OpenFiles, AreAsManyAsTheSystemAllows) {
  rlimit usual{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &usual), 0);
  rlimit few = usual;
  few.rlim_cur = 20;
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &few), 0);
  EXPECT_LT(opened(40), 40);
  allow_all_open_files();
  EXPECT_EQ(opened(40), 40);
  EXPECT_EQ(setrlimit(RLIMIT_NOFILE, &usual), 0);
}

}  // namespace
}  // namespace roadfix::cli
