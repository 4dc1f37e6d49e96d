#include "core/proof/bound_terms.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <vector>

#include "core/proof/bound_map.hpp"

namespace roadfix {
namespace {

/// Terms with the plane values that they meet somewhere.
struct Sum {
  WeightedTerms terms;  ///< a term's column is its index
  std::vector<std::uint32_t> values;

  double exact() const {
    double sum = 0.0;
    for (const auto& [weight, term] : terms) sum += weight * values[static_cast<std::size_t>(term.col)];
    return sum;
  }
  /// As term_sums() adds up.
  double rounded(Rounding rounding) const {
    const BoundTerms sum = quantized(terms, rounding);
    double units = 0.0;
    std::size_t i = 0;
    for (const BoundTerms::Group& group : sum.groups) {
      for (; i < group.end; ++i) units += 1.0 * group.weight * values[static_cast<std::size_t>(sum.terms[i].col)];
    }
    EXPECT_EQ(i, sum.terms.size());
    EXPECT_LT(units, 4294967296.0);
    return units * sum.unit;
  }
};

class BoundTermsSums : public ::testing::Test {
 protected:
  Sum drawn(int count, double heaviest) {
    std::uniform_real_distribution<double> weight(0.0, heaviest);
    std::uniform_int_distribution<std::uint32_t> value(0, BoundMap::kFull);
    Sum sum;
    for (int i = 0; i < count; ++i) {
      sum.terms.emplace_back(weight(random_), BoundTerms::Term{static_cast<std::int16_t>(i), 0, 0});
      sum.values.push_back(value(random_));
    }
    return sum;
  }
  std::mt19937_64 random_{5};
};

TEST_F(BoundTermsSums, AreAtLeastOrAtMostThoseOfTheExactWeights) {
  for (const int count : {1, 2, 63, 64, 65, 700, 20000}) {
    for (const double heaviest : {3.0, 1e3, 1e7}) {
      const Sum sum = drawn(count, heaviest);
      EXPECT_GE(sum.rounded(Rounding::kUp), sum.exact()) << count << " of " << heaviest;
      EXPECT_LE(sum.rounded(Rounding::kDown), sum.exact()) << count << " of " << heaviest;
    }
  }
}

// Weights share 64 groups: each is off by a 64th of the heaviest at most, on average.
TEST_F(BoundTermsSums, AreNotFarFromThem) {
  const Sum sum = drawn(2000, 1e4);
  EXPECT_LT(sum.rounded(Rounding::kUp), 1.03 * sum.exact());
  EXPECT_GT(sum.rounded(Rounding::kDown), 0.97 * sum.exact());
}

TEST_F(BoundTermsSums, LeaveOutTermsWithoutWeight) {
  Sum sum = drawn(10, 100.0);
  sum.terms[3].first = sum.terms[7].first = 0.0;
  EXPECT_EQ(quantized(sum.terms, Rounding::kUp).terms.size(), 8U);
  EXPECT_TRUE(quantized({}, Rounding::kDown).terms.empty());
}

}  // namespace
}  // namespace roadfix
