#include "core/scan/scan_tile.hpp"

#include <algorithm>
#include <cassert>

#include "core/scan/scan_kernel.hpp"

namespace roadfix {
namespace {

int padded_for_vectors(int cols) { return cols + kRowOverrun; }

}  // namespace

std::size_t ScanDirection::count() const {
  return static_cast<std::size_t>(std::ranges::count_if(bins, [](const auto& bin) { return bin.has_value(); }));
}

ScanBuffers::ScanBuffers(const ScanMap& map)
    : cross(map.values().side()),
      workspace(map.values().side()),
      means_workspace(map),
      scores(padded_for_vectors(map.values().side()), map.values().side()) {}

TileScan::TileScan(const ScanMap& map, const ScanRequest& request)
    : map_(map),
      request_(request),
      lead_col_(request.positions.origin.col - map.geometry().origin.col),
      lead_row_(request.positions.origin.row - map.geometry().origin.row),
      alignment_(map, {request.positions.cols, request.positions.rows, lead_col_, lead_row_}),
      eligible_(padded_for_vectors(request.positions.cols + 2), request.positions.rows + 2) {
  assert(lead_col_ >= map.reach() && lead_row_ >= map.reach());
  for (int row = 0; row < request.positions.rows; ++row) {
    for (int col = 0; col < request.positions.cols; ++col) {
      eligible_.at(col + 1, row + 1) = request.eligible(col, row) ? 1.0F : 0.0F;
    }
  }
}

void TileScan::scan(std::size_t tile, const ScanDirection& direction, float floor, ScanBuffers& buffers,
                    ScanFindings& found) const {
  const bool half_turn = direction.half_turn;
  const Correlator::TileSums sums = map_.values().correlate_tile(tile, buffers.cross, half_turn, buffers.workspace);
  // With the nadir at map cell p, the patch's first cell is at p - reach; turned by half a turn, at p + reach.
  const int shift = (half_turn ? map_.reach() : -map_.reach()) + Correlator::kLead;
  const auto positions = [&](int place, int count, int lead, int size) {
    const int first = place - lead - shift;
    return IndexRange{std::max(first, -1), std::min(first + count, size + 1)};
  };
  const Positions at{positions(sums.col, sums.cols, lead_col_, request_.positions.cols),
                     positions(sums.row, sums.rows, lead_row_, request_.positions.rows)};
  if (at.cols.count() < 3 || at.rows.count() < 3) return;
  interpolate_means(half_turn, at, buffers);
  const std::ptrdiff_t start =
      (at.rows.first + lead_row_ + shift - sums.row) * sums.stride + at.cols.first + lead_col_ + shift - sums.col;
  for (std::size_t i = 0; i < direction.bins.size(); ++i) {
    if (!direction.bins[i]) continue;
    const float* from = (i == 0 ? sums.first : sums.second) + start;
    score(half_turn, at, {from, sums.stride, i == 0 ? sums.first_scale : sums.second_scale}, buffers);
    collect(*direction.bins[i], at, floor, buffers, found);
  }
}

/// Interpolates the means to the columns of a tile, in the rows of blocks that the tile needs.
void TileScan::interpolate_means(bool half_turn, const Positions& at, ScanBuffers& buffers) const {
  const InterpolationTaps& row_taps = alignment_.row_taps(half_turn);
  const IndexRange blocks{row_taps.first[static_cast<std::size_t>(at.rows.first + 1)],
                          row_taps.second[static_cast<std::size_t>(at.rows.end)] + 1};
  const ScanMeans& means = buffers.means[half_turn ? 1 : 0];
  const InterpolationTaps& col_taps = alignment_.col_taps(half_turn);
  interpolate_cols(means.correction, col_taps, at.cols, blocks, buffers.correction);
  interpolate_cols(means.gain, col_taps, at.cols, blocks, buffers.gain);
}

void TileScan::interpolate_cols(const FloatPlane& blocks, const InterpolationTaps& taps, IndexRange cols,
                                IndexRange rows, FloatPlane& out) {
  out.resize(padded_for_vectors(cols.count()), rows.count());
  const std::ptrdiff_t from = cols.first + 1;
  for (int row = 0; row < out.rows; ++row) {
    interpolate_blocks(blocks.row(rows.first + row), taps.first.data() + from, taps.second.data() + from,
                       taps.share.data() + from, cols.count(), out.row(row));
  }
}

void TileScan::score(bool half_turn, const Positions& at, const Cross& cross, ScanBuffers& buffers) const {
  const InterpolationTaps& row_taps = alignment_.row_taps(half_turn);
  const int first_block = row_taps.first[static_cast<std::size_t>(at.rows.first + 1)];
  for (int row = at.rows.first; row < at.rows.end; ++row) {
    const auto place = static_cast<std::size_t>(row + 1);
    const int above = row_taps.first[place] - first_block;
    const int below = row_taps.second[place] - first_block;
    ScoreRow scored;
    scored.sums = cross.sums + (row - at.rows.first) * cross.stride;
    scored.scale = cross.scale;
    scored.correction = {buffers.correction.row(above), buffers.correction.row(below)};
    scored.gain = {buffers.gain.row(above), buffers.gain.row(below)};
    scored.share = row_taps.share[place];
    scored.eligible = eligible_.row(row + 1) + at.cols.first + 1;
    score_row(scored, at.cols.count(), buffers.scores.row(row - at.rows.first));
  }
}

/// Collects the scores that are maxima among their eight neighbours, and sums the squares of all.
void TileScan::collect(int bin, const Positions& at, float floor, ScanBuffers& buffers, ScanFindings& found) {
  for (int row = 1; row + 1 < at.rows.count(); ++row) {
    const float* scores = buffers.scores.row(row);
    buffers.peaks.clear();
    const RowTotals totals = summarize_row(buffers.scores.row(row - 1), scores, buffers.scores.row(row + 1), 1,
                                           at.cols.count() - 1, floor, buffers.peaks);
    found.squares += totals.squares;
    found.poses += totals.poses;
    for (const int col : buffers.peaks) {
      found.maxima.push_back({at.cols.first + col, at.rows.first + row, bin, scores[col]});
    }
  }
}

}  // namespace roadfix
