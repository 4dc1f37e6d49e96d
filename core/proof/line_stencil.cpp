#include "core/proof/line_stencil.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace roadfix {
namespace {

constexpr double kLineCells = 16.0;

std::vector<CellOffset> drawn(int index) {
  const double angle = std::numbers::pi * index / kLineDirections;
  const double across = std::cos(angle);
  const double down = std::sin(angle);
  const bool along_cols = std::abs(across) >= std::abs(down);
  const int cells = static_cast<int>(std::lround(kLineCells * std::max(std::abs(across), std::abs(down))));
  const double slope = along_cols ? down / across : across / down;
  std::vector<CellOffset> line;
  for (int i = -cells / 2; i < cells - cells / 2; ++i) {
    const int side = static_cast<int>(std::lround(i * slope));
    line.push_back(along_cols ? CellOffset{i, side} : CellOffset{side, i});
  }
  return line;
}

}  // namespace

const std::vector<CellOffset>& line_stencil(int index) {
  static const auto kStencils = [] {
    std::array<std::vector<CellOffset>, kLineDirections> all;
    for (int i = 0; i < kLineDirections; ++i) all[static_cast<std::size_t>(i)] = drawn(i);
    return all;
  }();
  return kStencils[static_cast<std::size_t>(index)];
}

}  // namespace roadfix
