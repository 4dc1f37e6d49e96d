// Map cells laid out for the matching kernel: row after row without gaps, readable beyond the end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/grid/cell_array.hpp"

namespace roadfix {

class MapPlane {
 public:
  explicit MapPlane(const CellArray& cells);

  int cols() const { return cols_; }
  int rows() const { return rows_; }
  bool all_observed() const { return all_observed_; }
  std::size_t bytes() const { return bytes_.size(); }
  std::ptrdiff_t stride() const { return cols_; }
  const std::uint8_t* at(int col, int row) const { return bytes_.data() + row * stride() + col; }

  /// Vectors may read past the end of a row by less than this.
  static constexpr int kOverread = 64;

 private:
  int cols_;
  int rows_;
  bool all_observed_ = false;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace roadfix
