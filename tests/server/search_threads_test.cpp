#include "server/search_threads.hpp"

#include <gtest/gtest.h>

namespace roadfix::server {
namespace {

TEST(SearchThreads, ASearchThatRunsAloneHasThemAll) {
  SearchThreads threads(8);
  for (int round = 0; round < 3; ++round) EXPECT_EQ(SearchThreads::Share(threads).threads(), 8);
}

TEST(SearchThreads, SearchesThatComeLaterGetTheirPartAndKeepIt) {
  SearchThreads threads(8);
  const SearchThreads::Share first(threads);
  const SearchThreads::Share second(threads);
  {
    const SearchThreads::Share third(threads);
    EXPECT_EQ(third.threads(), 2);
  }
  EXPECT_EQ(first.threads(), 8);
  EXPECT_EQ(second.threads(), 4);
  EXPECT_EQ(SearchThreads::Share(threads).threads(), 2) << "as the third one, which has ended";
}

TEST(SearchThreads, EverySearchHasOneAtLeast) {
  SearchThreads threads(2);
  const SearchThreads::Share first(threads);
  const SearchThreads::Share second(threads);
  EXPECT_EQ(SearchThreads::Share(threads).threads(), 1);
}

}  // namespace
}  // namespace roadfix::server
