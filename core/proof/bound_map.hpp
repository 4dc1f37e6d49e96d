// The map's part of an upper bound on scores: the most that a feature map can match anywhere in a block of positions.
//
// A block is kBlockCells x kBlockCells nadir cells. The feature map consists of pieces of road: lines of some
// direction, and single cells. If a piece lies in the block (col, row) relative to the nadir's block, a plane holds the
// most that it can match there over all positions of the piece and of the nadir within their blocks: a maximum over (2
// kBlockCells - 1)^2 places. What a footprint matches in a block is at most the sum over its pieces. Thread-safe once
// built.
#pragma once

#include <cstdint>
#include <vector>

#include "core/grid/road_grid.hpp"
#include "core/match/deadline.hpp"
#include "core/match/map_plane.hpp"
#include "core/proof/line_stencil.hpp"

namespace roadfix {

inline constexpr int kBlockCells = 4;
/// Side, in map cells, of the square that a block of a footprint can cover while the nadir is anywhere in its block.
inline constexpr int kBlockWindow = 2 * kBlockCells - 1;

class BoundMap {
 public:
  /// Planes of a block: one per line direction, one for single cells, two that say whether the map was observed.
  static constexpr int kCellPlane = kLineDirections;
  static constexpr int kAllObserved = kLineDirections + 1;  ///< kFull if every place is observed, else 0
  static constexpr int kAnyObserved = kLineDirections + 2;  ///< kFull if any place is observed, else 0
  static constexpr int kPlanes = kLineDirections + 3;
  /// The value of a piece all of whose cells are on the map's highest cells (base() + span()).
  static constexpr int kFull = 63;
  /// Blocks of a row are read so many at a time.
  static constexpr int kRun = 64;

  /// Thrown where the map was not done at its deadline.
  struct TimeIsOver {};

  /// Bounds hold for positions from which a footprint stays kBorder cells or more within the grid. Throws TimeIsOver
  /// some tenths of a second after the deadline or a stop at the latest.
  explicit BoundMap(const RoadGrid& grid, const Deadline& deadline = {});
  static constexpr int kBorder = 16;

  const GridGeometry& geometry() const { return geometry_; }
  /// The least value of an observed cell; bounds are over values above it.
  int base() const { return base_; }
  /// The largest value above base, at least 1.
  int span() const { return span_; }

  std::ptrdiff_t stride() const { return stride_; }
  /// Readable from -kMargin to size + kMargin blocks and kRun further to the right.
  const std::uint8_t* plane(int index, int col, int row) const {
    return planes_[static_cast<std::size_t>(index)].data() + (row + kMargin) * stride_ + col + kMargin;
  }

  /// Sums over the blocks of a row before this one (modulo 2^32): observed cells, value above base, its square.
  struct Sums {
    const std::uint32_t *cells, *value, *square;
  };
  Sums sums_before(int col, int row) const {
    const auto at = static_cast<std::size_t>((row + kMargin) * stride_ + col + kMargin);
    return {cells_.data() + at, value_.data() + at, square_.data() + at};
  }

  /// The cells themselves; and for each cell the maximum over the side x side cells from it on, less base (side 2 or
  /// 4).
  const MapPlane& exact() const { return exact_; }
  const MapPlane& pooled(int side) const { return side == 2 ? pooled2_ : pooled4_; }

  bool all_observed() const { return exact_.all_observed(); }
  std::size_t bytes() const;

 private:
  /// For each block the most that the piece can match in it, in units of 1 / kFull. `above`: the cells less base.
  void fill_piece_plane(int index, const std::vector<CellOffset>& piece, const CellArray& above);
  void fill_observed(const CellArray& cells);
  void fill_sums(const CellArray& cells);
  std::uint8_t* plane(int index, int col, int row) {
    return planes_[static_cast<std::size_t>(index)].data() + (row + kMargin) * stride_ + col + kMargin;
  }

  GridGeometry geometry_;
  int block_cols_;  ///< block (0, 0) is the north-western one; its cells start at geometry().origin
  int block_rows_;
  static constexpr int kMargin = 4;
  std::ptrdiff_t stride_;
  int base_ = 0;
  int span_ = 1;
  std::vector<std::vector<std::uint8_t>> planes_;
  std::vector<std::uint32_t> cells_, value_, square_;
  MapPlane exact_, pooled2_, pooled4_;
};

}  // namespace roadfix
