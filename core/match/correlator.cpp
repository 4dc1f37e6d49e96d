#include "core/match/correlator.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace roadfix {
namespace {

int tiles_along(int cells, int patch, int side) {
  const int places = std::max(1, cells + 2 * Correlator::kLead - patch + 1);
  const int step = side - patch + 1;
  return (places + step - 1) / step;
}

/// The side of the tiles that take the least work.
int best_side(const FloatPlane& plane, int patch) {
  constexpr int kBeyondCache = 512;  // its transforms wait for memory
  int best = 0;
  double least = 0.0;
  for (int side = FourierTransform::kLeastSide; best == 0 || side <= kBeyondCache; side *= 2) {
    if (side < patch) continue;
    const double tiles = double{1} * tiles_along(plane.cols, patch, side) * tiles_along(plane.rows, patch, side);
    const double work = tiles * side * side * (2.0 + std::log2(side)) * (side >= kBeyondCache ? 1.5 : 1.0);
    if (best != 0 && work >= least) continue;
    best = side;
    least = work;
  }
  return best;
}

/// The part of the plane that lies in a square from (col, row) on.
void fill(const FloatPlane& plane, int col, int row, int side, float* out, std::ptrdiff_t stride) {
  const int first = std::max(0, -col);
  const int last = std::min(side, plane.cols - col);
  for (int r = std::max(0, -row); r < std::min(side, plane.rows - row); ++r) {
    const float* in = plane.row(row + r) + col;
    if (first < last) std::copy(in + first, in + last, out + r * stride + first);
  }
}

}  // namespace

Correlator::Correlator(const FloatPlane& first, const FloatPlane& second, int patch)
    : cols_(first.cols),
      rows_(first.rows),
      patch_(patch),
      pair_(!second.values.empty()),
      fourier_(best_side(first, patch)) {
  assert(!pair_ || (second.cols == cols_ && second.rows == rows_));
  const int side = fourier_.side();
  ComplexPlane scratch(side);
  for (int i = 0; i < tiles_along(rows_, patch, side); ++i) {
    for (int k = 0; k < tiles_along(cols_, patch, side); ++k) {
      const int step = side - patch + 1;
      Tile tile{k * step - kLead, i * step - kLead, ComplexPlane(side)};
      fill(first, tile.col, tile.row, side, tile.spectrum.re(), tile.spectrum.stride());
      if (pair_) fill(second, tile.col, tile.row, side, tile.spectrum.im(), tile.spectrum.stride());
      fourier_.forward(tile.spectrum, scratch);
      tiles_.push_back(std::move(tile));
    }
  }
}

std::size_t Correlator::bytes() const {
  std::size_t bytes = 0;
  for (const Tile& tile : tiles_) bytes += tile.spectrum.bytes();
  return bytes;
}

ComplexPlane Correlator::spectrum_of(const FloatPlane& first, const FloatPlane& second) const {
  assert(first.cols <= patch_ && first.rows <= patch_);
  assert(second.values.empty() || !pair_);
  ComplexPlane spectrum(fourier_.side());
  fill(first, 0, 0, fourier_.side(), spectrum.re(), spectrum.stride());
  if (!second.values.empty()) fill(second, 0, 0, fourier_.side(), spectrum.im(), spectrum.stride());
  ComplexPlane scratch(fourier_.side());
  fourier_.forward(spectrum, scratch);
  return spectrum;
}

FloatPlanes Correlator::correlate(const ComplexPlane& patch_spectrum, bool half_turn) const {
  const int cols = cols_ + 2 * kLead;
  const int rows = rows_ + 2 * kLead;
  FloatPlanes result{FloatPlane(cols, rows), FloatPlane(cols, rows)};
  const int side = fourier_.side();
  ComplexPlane sums(side);
  ComplexPlane scratch(side);
  // Where a tile's cyclic sums do not wrap around.
  const int inset = half_turn ? patch_ - 1 : 0;
  const int step = side - patch_ + 1;
  const auto scale = 1.0F / (static_cast<float>(side) * static_cast<float>(side));
  // The conjugate of a pair of patches is the pair with its second one negative.
  const float scale2 = pair_ || half_turn ? scale : -scale;
  for (const Tile& tile : tiles_) {
    const int first_col = tile.col + kLead + inset;
    const int first_row = tile.row + kLead + inset;
    const int count = std::min(step, cols - first_col);
    if (count <= 0 || first_row >= rows) continue;
    multiply(tile.spectrum, patch_spectrum, !half_turn, sums);
    fourier_.backward(sums, scratch);
    for (int r = 0; r < std::min(step, rows - first_row); ++r) {
      const float* re = sums.re(inset + r) + inset;
      const float* im = sums.im(inset + r) + inset;
      float* first = result.first.row(first_row + r) + first_col;
      float* second = result.second.row(first_row + r) + first_col;
      for (int c = 0; c < count; ++c) {
        first[c] = scale * re[c];
        second[c] = scale2 * im[c];
      }
    }
  }
  return result;
}

}  // namespace roadfix
