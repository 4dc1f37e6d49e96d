#include "core/scan/correlator.hpp"

#include <algorithm>
#include <cassert>

namespace roadfix {
namespace {

int tiles_along(int cells, int patch, int overlap, int side) {
  const int places = std::max(1, cells + 2 * Correlator::kLead - patch + 1 - overlap);
  const int step = side - patch + 1 - overlap;
  return (places + step - 1) / step;
}

/// The side of tiles that takes the least work: a tile hardly larger than the patch has few places, a large one leaves
/// the caches.
int best_side(const FloatPlane& plane, int patch, int overlap) {
  const int longest = std::max(512, 2 * (patch + overlap));
  // Measured: the cost of a cell is about proportional to this plus the tile's side, as tiles outgrow the caches.
  constexpr double kCellCost = 160.0;
  int best = 0;
  double best_work = 0.0;
  for (int side = FourierTransform::kMinSide; best == 0 || side <= longest; side += kStripCols) {
    if (!FourierTransform::is_side(side) || side < patch + overlap) continue;
    const double tiles =
        double{1} * tiles_along(plane.cols, patch, overlap, side) * tiles_along(plane.rows, patch, overlap, side);
    const double work = tiles * side * side * (kCellCost + side);
    if (best != 0 && work >= best_work) continue;
    best = side;
    best_work = work;
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

/// The value of all cells of the square from (col, row) on, with 0 beyond the plane; nullopt if they differ.
std::optional<float> only_value(const FloatPlane& plane, int col, int row, int side) {
  if (plane.values.empty()) return 0.0F;
  const bool inside = col >= 0 && row >= 0 && col + side <= plane.cols && row + side <= plane.rows;
  const float value = inside ? plane.at(col, row) : 0.0F;
  for (int r = std::max(0, row); r < std::min(plane.rows, row + side); ++r) {
    const float* cells = plane.row(r);
    const auto differs = [value](float cell) { return cell != value; };
    if (std::any_of(cells + std::max(0, col), cells + std::min(plane.cols, col + side), differs)) return std::nullopt;
  }
  return value;
}

}  // namespace

Correlator::Correlator(const FloatPlane& first, const FloatPlane& second, int patch, int overlap)
    : cols_(first.cols),
      rows_(first.rows),
      patch_(patch),
      pair_(!second.values.empty()),
      fourier_(best_side(first, patch, overlap)) {
  assert(!pair_ || (second.cols == cols_ && second.rows == rows_));
  const int side = fourier_.side();
  const int step = side - patch + 1 - overlap;
  Workspace workspace(side);
  for (int i = 0; i < tiles_along(rows_, patch, overlap, side); ++i) {
    for (int k = 0; k < tiles_along(cols_, patch, overlap, side); ++k) {
      tiles_.push_back(tile_at(first, second, k * step - kLead, i * step - kLead, workspace));
    }
  }
}

Correlator::Tile Correlator::tile_at(const FloatPlane& first, const FloatPlane& second, int col, int row,
                                     Workspace& workspace) const {
  const int side = fourier_.side();
  const auto only_first = only_value(first, col, row, side);
  const auto only_second = only_value(second, col, row, side);
  if (only_first && only_second) return {col, row, std::nullopt, *only_first, *only_second};
  Tile tile{col, row, Spectrum(side), 0.0F, 0.0F};
  ComplexPlane& plane = workspace.sums;
  plane.clear(side);
  fill(first, col, row, side, plane.re(), plane.stride());
  if (pair_) fill(second, col, row, side, plane.im(), plane.stride());
  fourier_.forward(plane, {side, side}, workspace.scratch, *tile.spectrum);
  return tile;
}

std::size_t Correlator::bytes() const {
  std::size_t bytes = 0;
  for (const Tile& tile : tiles_) bytes += tile.spectrum ? tile.spectrum->bytes() : sizeof(Tile);
  return bytes;
}

void Correlator::spectrum_of(const FloatPlane& first, const FloatPlane& second, Workspace& workspace,
                             Spectrum& spectrum) const {
  assert(first.cols <= patch_ && first.rows <= patch_);
  assert(second.values.empty() || !pair_);
  const Filled filled{std::max(first.cols, second.cols), std::max(first.rows, second.rows)};
  ComplexPlane& plane = workspace.sums;
  plane.clear(filled.rows);
  fill(first, 0, 0, side(), plane.re(), plane.stride());
  if (!second.values.empty()) fill(second, 0, 0, side(), plane.im(), plane.stride());
  fourier_.forward(plane, filled, workspace.scratch, spectrum);
}

Correlator::TileSums Correlator::correlate_tile(std::size_t index, const Spectrum& patch_spectrum, bool half_turn,
                                                Workspace& workspace) const {
  const Tile& tile = tiles_[index];
  // Where a tile's cyclic sums do not wrap around.
  const int inset = half_turn ? patch_ - 1 : 0;
  const int size = side() - patch_ + 1;
  TileSums result;
  result.col = tile.col + kLead + inset;
  result.row = tile.row + kLead + inset;
  result.cols = std::min(size, sum_cols() - result.col);
  result.rows = std::min(size, sum_rows() - result.row);
  if (result.cols <= 0 || result.rows <= 0) return {};
  result.first = workspace.sums.re(inset) + inset;
  result.second = workspace.sums.im(inset) + inset;
  if (!tile.spectrum) {
    // The patches' own sums are known; one row of them stands for all.
    const float patch_first = patch_spectrum.sum_re();
    const float patch_second = patch_spectrum.sum_im();
    std::fill_n(workspace.sums.re(inset), side(), tile.first * patch_first);
    std::fill_n(workspace.sums.im(inset), side(), pair_ ? tile.second * patch_first : tile.first * patch_second);
    return result;
  }
  const IndexRange wanted{inset, inset + result.cols};
  fourier_.backward_of_product(*tile.spectrum, patch_spectrum, !half_turn, wanted, workspace.sums, workspace.scratch);
  result.stride = workspace.sums.stride();
  result.first_scale = 1.0F / (static_cast<float>(side()) * static_cast<float>(side()));
  // The conjugate of a pair of patches is the pair with its second one negative.
  result.second_scale = pair_ || half_turn ? result.first_scale : -result.first_scale;
  return result;
}

void Correlator::correlate(const Spectrum& patch_spectrum, bool half_turn, Workspace& workspace,
                           FloatPlanes& result) const {
  for (FloatPlane* plane : {&result.first, &result.second}) {
    plane->resize(sum_cols(), sum_rows());
    std::ranges::fill(plane->values, 0.0F);
  }
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    const TileSums tile = correlate_tile(i, patch_spectrum, half_turn, workspace);
    for (int r = 0; r < tile.rows; ++r) {
      float* first = result.first.row(tile.row + r) + tile.col;
      float* second = result.second.row(tile.row + r) + tile.col;
      for (int c = 0; c < tile.cols; ++c) {
        first[c] = tile.first_scale * tile.first[r * tile.stride + c];
        second[c] = tile.second_scale * tile.second[r * tile.stride + c];
      }
    }
  }
}

}  // namespace roadfix
