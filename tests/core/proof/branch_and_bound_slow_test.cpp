#include "tests/core/proof/bounded_case.hpp"

namespace roadfix {
namespace {

TEST(BranchAndBoundAtLength, FindsTheBestScoreOfBruteForceOnThousandsOfSmallMaps) {
  for (std::uint64_t seed = 1000; seed < 3000; ++seed) {
    SCOPED_TRACE(seed);
    testing::expect_brute_force_agrees(testing::BoundedCase(seed));
  }
}

}  // namespace
}  // namespace roadfix
