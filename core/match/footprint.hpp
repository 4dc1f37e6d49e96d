// A feature map turned to grid north-up, packed for the matching kernel.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/grid/feature_map.hpp"
#include "core/grid/feature_rotator.hpp"

namespace roadfix {

/// Holds spans of rows that begin and end with an observed cell. A row has several spans if that saves whole blocks of
/// kAlignment cells.
class PackedFootprint {
 public:
  static constexpr int kAlignment = 32;

  struct Span {
    int first_col = 0;  ///< relative to the nadir cell
    int row = 0;        ///< relative to the nadir cell
    int cells = 0;
    std::size_t offset = 0;  ///< into values() and mask(), multiple of kAlignment
  };

  /// `north_up` comes from rotated(): its nadir lies within the cell that counts as the centre.
  explicit PackedFootprint(const FeatureMap& north_up);

  std::span<const Span> spans() const { return spans_; }
  /// 0..254, 0 where unobserved or padding; an even number of blocks of kAlignment.
  const std::uint8_t* values() const { return values_.data()->cells; }
  /// 255 where observed, else 0.
  const std::uint8_t* mask() const { return mask_.data()->cells; }
  /// Where in a plane of that stride the cells below each block of values() lie, as seen from that below the nadir.
  std::vector<std::ptrdiff_t> block_offsets(std::ptrdiff_t stride) const;
  /// Largest distance of an observed cell from the nadir cell along either axis: how far from the rim of a MapPlane the
  /// nadir has to stay.
  int reach() const { return reach_; }

  // Sums over all observed cells, in units of 1/254.
  std::int64_t observed_cells() const { return observed_cells_; }
  std::int64_t sum() const { return sum_; }
  std::int64_t sum_of_squares() const { return sum_of_squares_; }

 private:
  struct alignas(kAlignment) Block {
    Block() { std::fill_n(cells, kAlignment, kUnobserved); }
    Cell cells[kAlignment];
  };

  void mask_and_count(Block& values, Block& mask);

  std::vector<Span> spans_;
  std::vector<Block> values_;
  std::vector<Block> mask_;
  int reach_ = 0;
  std::int64_t observed_cells_ = 0;
  std::int64_t sum_ = 0;
  std::int64_t sum_of_squares_ = 0;
};

/// How many cells a footprint reaches from its nadir along either axis, at any heading.
int footprint_reach(const FeatureMap& features);

/// The footprint of a feature map at a grid heading, resampled so that its nadir lies `offset` (in cells, each
/// component within +-0.5) from the centre of a cell.
PackedFootprint footprint_at(const FeatureMap& map, Angle grid_heading, GridGeometry::CellPosition offset = {});
/// With its nadir in the middle of a cell.
PackedFootprint footprint_at(const FeatureRotator& features, Angle grid_heading);

}  // namespace roadfix
