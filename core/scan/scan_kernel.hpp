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

/// Sums over a footprint, block by block: cells observed in both, values and squares of the feature map there, values
/// and squares of the map.
struct BlockRow {
  const float *n, *l, *ll, *m, *mm;
};
/// Where fewer than min_cells of full_cells are observed, or the variance is less than min_variance, there is no
/// score.
struct MeansLimits {
  float full_cells = 1.0F;
  float min_cells = 1.0F;
  float min_variance = 0.0F;
};
/// correction = m l / n, gain = sqrt(n / full_cells / ((mm - m m / n) (ll - l l / n))); both 0 where there is no score.
/// Nothing is read or written beyond `count`.
void means_of_blocks(const BlockRow& sums, const MeansLimits& limits, int count, float* correction, float* gain);

/// Linear interpolation: out[i] = blocks[first[i]] + share[i] (blocks[second[i]] - blocks[first[i]]).
void interpolate_blocks(const float* blocks, const std::int32_t* first, const std::int32_t* second, const float* share,
                        int count, float* out);

}  // namespace roadfix
