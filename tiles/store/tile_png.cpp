#include "tiles/store/tile_png.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <utility>

#include "core/png/png_codec.hpp"
#include "core/units/error.hpp"
#include "tiles/store/map_records.hpp"

namespace roadfix {
namespace {

constexpr std::uint16_t kNull16 = 0xffff;

PngShape shape_of(TileDepth depth) { return {kTileCells, kTileCells, 1, static_cast<int>(depth)}; }

std::vector<std::uint8_t> pack(std::span<const Cell> cells) {
  std::vector<std::uint8_t> pixels(2 * cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    pixels[2 * i] = is_observed(cells[i]) ? 0 : 0xff;
    pixels[2 * i + 1] = cells[i];
  }
  return pixels;
}

void unpack(std::span<const std::uint8_t> pixels, std::span<Cell> cells) {
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto value = static_cast<std::uint16_t>(pixels[2 * i] << 8 | pixels[2 * i + 1]);
    if (value > kRoad && value != kNull16) {
      throw CorruptData("tile-corrupt", fmt::format("value {} is neither 0..254 nor unobserved", value));
    }
    cells[i] = static_cast<Cell>(value == kNull16 ? kUnobserved : value);
  }
}

void read_pixels(std::span<const std::byte> png, TileDepth depth, std::span<std::uint8_t> pixels) {
  try {
    PngReader reader(png, PngOrigin::kOwn);
    if (reader.shape() != shape_of(depth)) {
      throw CorruptData("tile-corrupt", "not 256 x 256 pixels of the expected depth");
    }
    reader.read(pixels);
  } catch (const CorruptData& error) {
    throw CorruptData("tile-corrupt", fmt::format("PNG decoder: {}", error.what()));
  }
}

std::vector<std::byte> encoded(std::span<const std::uint8_t> pixels, TileDepth depth) {
  auto differences = encode_grey_png(pixels, shape_of(depth), PngFilter::kDifferenceToRowAbove);
  // Runs are of bytes: 16 bits as they are have none to speak of, and take four times as long to pack.
  if (depth == TileDepth::kFused) return differences;
  // Detections (noise) need less room as they are, others with differences between rows: try both.
  auto plain = encode_grey_png(pixels, shape_of(depth), PngFilter::kNone);
  return plain.size() <= differences.size() ? plain : differences;
}

std::vector<std::byte> encoded(const CellArray& cells, TileDepth depth) {
  return depth == TileDepth::kFused ? encoded(pack(cells.cells()), depth) : encoded(cells.cells(), depth);
}

/// Of cells that are all alike. Where a map is drawn from roads, up to half of its tiles show country without any.
std::vector<std::byte> encoded_once(const CellArray& cells, TileDepth depth) {
  static std::mutex mutex;
  static std::map<std::pair<TileDepth, Cell>, std::vector<std::byte>> kept;
  const std::lock_guard lock(mutex);
  std::vector<std::byte>& png = kept[{depth, cells.cells().front()}];
  if (png.empty()) png = encoded(cells, depth);
  return png;
}

}  // namespace

std::vector<std::byte> encode_tile(const CellArray& cells, TileDepth depth) {
  assert(cells.cols() == kTileCells && cells.rows() == kTileCells);
  const auto all = cells.cells();
  const bool alike = std::ranges::adjacent_find(all, std::ranges::not_equal_to{}) == all.end();
  return alike ? encoded_once(cells, depth) : encoded(cells, depth);
}

CellArray decode_tile(std::span<const std::byte> png, TileDepth depth) {
  CellArray cells(kTileCells, kTileCells);
  if (depth == TileDepth::kEvidence) {
    read_pixels(png, depth, cells.cells());
  } else {
    std::vector<std::uint8_t> pixels(shape_of(depth).bytes());
    read_pixels(png, depth, pixels);
    unpack(pixels, cells.cells());
  }
  return cells;
}

}  // namespace roadfix
