// What a scan does with the sums of its correlations, row by row: scores, their spread and their peaks. Vectorised for
// the processor that runs it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace roadfix {

/// Rows may be read and written beyond their end by less than this.
inline constexpr int kRowOverrun = 16;

/// Score = eligible * (scale * sum - correction) * gain; correction and gain lie between two rows.
struct ScoreRow {
  const float* sums = nullptr;
  float scale = 1.0F;
  std::array<const float*, 2> correction{};
  std::array<const float*, 2> gain{};
  float share = 0.0F;               ///< of the second row
  const float* eligible = nullptr;  ///< 1 or 0
};
void score_row(const ScoreRow& row, int cols, float* out);

struct RowTotals {
  double squares = 0.0;
  std::int64_t poses = 0;  ///< with another score than 0
};

/// Over the columns [first, last) of the row in the middle. Those that exceed `floor` and that none of their eight
/// neighbours exceeds are added to `peaks`.
RowTotals summarize_row(const float* above, const float* row, const float* below, int first, int last, float floor,
                        std::vector<int>& peaks);

}  // namespace roadfix
