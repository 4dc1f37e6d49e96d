// Heights of the ground on the plane of a UTM zone, as an elevation model tells them: above the sea, as an autopilot
// counts its own height, so that the difference is the height above ground.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/grid/geometry.hpp"

namespace roadfix {

struct HeightRange {
  double lowest_m = 0.0;
  double highest_m = 0.0;
  friend bool operator==(const HeightRange&, const HeightRange&) = default;
};

/// Mean heights of cells, each as a number of steps above kLowestM. Invariant: codes.size() == cols * rows.
struct Terrain {
  static constexpr double kFinestCellM = 32.0;
  static constexpr double kLowestM = -1000.0;
  static constexpr double kStepM = 0.2;
  static constexpr std::uint16_t kUnknown = 65535;
  static constexpr HeightRange kHeights{kLowestM, kLowestM + kStepM*(kUnknown - 1)};

  GridGeometry geometry;             ///< in cells of kFinestCellM * 2^k
  std::vector<std::uint16_t> codes;  ///< row by row

  static Terrain unknown(const GridGeometry& geometry);
  /// The nearest of kHeights; kUnknown for NaN.
  static std::uint16_t code_of(double height_m);

  /// Of a cell; nullopt where it is unknown and beyond the grid.
  std::optional<double> cell_height_m(int col, int row) const;
  /// Bilinear between the centres of the cells around the point that are known; nullopt where none is.
  std::optional<double> height_m(GridPoint point) const;
  /// How far what is so high above the sea is above the ground at the point; nullopt where that is unknown, or not
  /// below.
  std::optional<double> height_above_ground_m(GridPoint point, double above_sea_m) const;
  /// Of the cells that the box touches, and those next to them; nullopt where none is known.
  std::optional<HeightRange> heights_within(const GridBox& box) const;

  friend bool operator==(const Terrain&, const Terrain&) = default;
};

}  // namespace roadfix
