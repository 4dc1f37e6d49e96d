#include "core/match/footprint.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "core/grid/resample.hpp"

namespace roadfix {
namespace {

/// Bits of eight cells that differ from unobserved ones, the first cell's lowest.
std::uint64_t observed_bits(const Cell* from) {
  static_assert(kUnobserved == 255 && std::endian::native == std::endian::little);
  std::uint64_t cells = 0;
  std::memcpy(&cells, from, sizeof(cells));
  return ~cells;
}

std::size_t unobserved_before(std::span<const Cell> row) {
  std::size_t count = 0;
  for (; count + 8 <= row.size(); count += 8) {
    const std::uint64_t bits = observed_bits(&row[count]);
    if (bits != 0) return count + static_cast<std::size_t>(std::countr_zero(bits)) / 8;
  }
  while (count < row.size() && !is_observed(row[count])) ++count;
  return count;
}

std::size_t unobserved_after(std::span<const Cell> row) {
  std::size_t end = row.size();
  for (; end >= 8; end -= 8) {
    const std::uint64_t bits = observed_bits(&row[end - 8]);
    if (bits != 0) return row.size() - end + static_cast<std::size_t>(std::countl_zero(bits)) / 8;
  }
  while (end > 0 && !is_observed(row[end - 1])) --end;
  return row.size() - end;
}

/// One past the last cell of the span that begins at the observed cell `first`. A span ends where its next block would
/// begin with an unobserved cell, so that the spans of a row take the fewest blocks.
std::size_t end_of_span(std::span<const Cell> row, std::size_t first) {
  std::size_t end = first + PackedFootprint::kAlignment;
  while (end < row.size() && is_observed(row[end])) end += PackedFootprint::kAlignment;
  end = std::min(end, row.size());
  return end - unobserved_after(row.subspan(first, end - first));
}

}  // namespace

PackedFootprint::PackedFootprint(const FeatureMap& north_up) {
  const CellArray& cells = north_up.cells;
  const int nadir_col = static_cast<int>(std::floor(north_up.nadir.col));
  const int nadir_row = static_cast<int>(std::floor(north_up.nadir.row));
  const std::size_t blocks_of_row = (static_cast<std::size_t>(cells.cols()) + kAlignment - 1) / kAlignment;
  values_.reserve(blocks_of_row * static_cast<std::size_t>(cells.rows()) + 1);
  for (int r = 0; r < cells.rows(); ++r) {
    const auto row = cells.row(r);
    const std::size_t end = row.size() - unobserved_after(row);
    for (std::size_t first = 0; (first += unobserved_before(row.subspan(first))) < end;) {
      const std::size_t last = end_of_span(row.first(end), first);
      const int first_col = static_cast<int>(first) - nadir_col;
      const int last_col = static_cast<int>(last) - 1 - nadir_col;
      const std::size_t block = values_.size();
      spans_.push_back({first_col, r - nadir_row, static_cast<int>(last - first), block * kAlignment});
      values_.resize(block + (last - first + kAlignment - 1) / kAlignment);
      std::memcpy(&values_[block], &row[first], last - first);
      reach_ = std::max({reach_, std::abs(first_col), std::abs(last_col), std::abs(r - nadir_row)});
      first = last;
    }
  }
  values_.resize((values_.size() + 1) / 2 * 2);
  mask_.resize(values_.size());
  for (std::size_t i = 0; i < values_.size(); ++i) mask_and_count(values_[i], mask_[i]);
}

/// Sets the mask of a block of cells, clears its unobserved cells, and adds it to the sums.
void PackedFootprint::mask_and_count(Block& values, Block& mask) {
  // Loops that compilers turn into vectors.
  std::uint32_t observed = 0;
  std::uint32_t sum = 0;
  std::int32_t squares = 0;
  for (std::size_t i = 0; i < kAlignment; ++i) {
    mask.cells[i] = is_observed(values.cells[i]) ? 255 : 0;
    values.cells[i] &= mask.cells[i];
    const std::int16_t value = values.cells[i];
    observed += mask.cells[i] & 1U;
    sum += values.cells[i];
    squares += value * value;
  }
  observed_cells_ += observed;
  sum_ += sum;
  sum_of_squares_ += squares;
}

std::vector<std::ptrdiff_t> PackedFootprint::block_offsets(std::ptrdiff_t stride) const {
  std::vector<std::ptrdiff_t> offsets;
  offsets.reserve(values_.size());
  for (const Span& span : spans_) {
    for (int i = 0; i < span.cells; i += kAlignment) offsets.push_back(span.row * stride + span.first_col + i);
  }
  if (offsets.size() < values_.size()) offsets.push_back(offsets.empty() ? 0 : offsets.back());
  return offsets;
}

int footprint_reach(const FeatureMap& features) {
  double reach = 0.0;
  for (const double col : {0.0, static_cast<double>(features.cells.cols())}) {
    for (const double row : {0.0, static_cast<double>(features.cells.rows())}) {
      reach = std::max(reach, std::hypot(col - features.nadir.col, row - features.nadir.row));
    }
  }
  return static_cast<int>(std::ceil(reach)) + 1;
}

PackedFootprint footprint_at(const FeatureMap& map, Angle grid_heading, GridGeometry::CellPosition offset) {
  // Moving the nadir off the cell's centre is moving the feature map under its nadir the other way, in the body frame.
  FeatureMap shifted = map;
  const double c = cos(grid_heading);
  const double s = sin(grid_heading);
  shifted.nadir.col -= c * offset.col + s * offset.row;
  shifted.nadir.row -= -s * offset.col + c * offset.row;
  return PackedFootprint(rotated(shifted, grid_heading));
}

PackedFootprint footprint_at(const FeatureRotator& features, Angle grid_heading) {
  return PackedFootprint(features.rotated(grid_heading));
}

}  // namespace roadfix
