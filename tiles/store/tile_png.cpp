#include "tiles/store/tile_png.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <map>
#include <mutex>
#include <utility>

#include "core/png/plain_png.hpp"
#include "core/png/png_reader.hpp"
#include "core/units/error.hpp"
#include "tiles/store/map_records.hpp"

namespace roadfix {
namespace {

PngShape shape_of(TileDepth depth) { return {kTileCells, kTileCells, 1, static_cast<int>(depth)}; }

constexpr PngShape kHeights{kTileCells, kTileCells, 1, 16};

std::vector<std::uint8_t> pack(std::span<const Cell> cells) {
  std::vector<std::uint8_t> pixels(2 * cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    pixels[2 * i] = is_observed(cells[i]) ? 0 : 0xff;
    pixels[2 * i + 1] = cells[i];
  }
  return pixels;
}

void unpack(std::span<const std::uint8_t> pixels, std::span<Cell> cells) {
  int wrong = 0;  // told after the loop, which the compiler then vectorises
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::uint8_t high = pixels[2 * i];
    cells[i] = pixels[2 * i + 1];
    wrong |= high ^ (is_observed(cells[i]) ? 0 : 0xff);
  }
  if (wrong != 0) throw CorruptData("tile-corrupt", "a value is neither 0..254 nor unobserved");
}

void read_pixels(std::span<const std::byte> png, const PngShape& shape, std::span<std::uint8_t> pixels) {
  if (read_plain_png(png, shape, pixels)) return;
  try {
    PngReader reader(png, PngOrigin::kOwn);
    if (reader.shape() != shape) {
      throw CorruptData("tile-corrupt", "not 256 x 256 pixels of the expected depth");
    }
    reader.read(pixels);
  } catch (const CorruptData& error) {
    throw CorruptData("tile-corrupt", fmt::format("PNG decoder: {}", error.what()));
  }
}

std::vector<std::byte> encoded(const CellArray& cells, TileDepth depth) {
  if (depth == TileDepth::kEvidence) return encode_plain_png(cells.cells(), shape_of(depth));
  return encode_plain_png(pack(cells.cells()), shape_of(depth));
}

/// For cells that are all alike, as up to half of the tiles of a map drawn from road data are.
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
  const bool alike = std::equal(all.begin() + 1, all.end(), all.begin());
  return alike ? encoded_once(cells, depth) : encoded(cells, depth);
}

CellArray decode_tile(std::span<const std::byte> png, TileDepth depth) {
  CellArray cells(kTileCells, kTileCells);
  if (depth == TileDepth::kEvidence) {
    read_pixels(png, shape_of(depth), cells.cells());
  } else {
    std::vector<std::uint8_t> pixels(shape_of(depth).bytes());
    read_pixels(png, shape_of(depth), pixels);
    unpack(pixels, cells.cells());
  }
  return cells;
}

std::vector<std::byte> encode_heights(std::span<const std::uint16_t> codes) {
  std::vector<std::uint8_t> pixels(kHeights.bytes());
  assert(2 * codes.size() == pixels.size());
  for (std::size_t i = 0; i < codes.size(); ++i) {
    pixels[2 * i] = static_cast<std::uint8_t>(codes[i] >> 8);
    pixels[2 * i + 1] = static_cast<std::uint8_t>(codes[i] & 0xff);
  }
  return encode_plain_png(pixels, kHeights);
}

std::vector<std::uint16_t> decode_heights(std::span<const std::byte> png) {
  std::vector<std::uint8_t> pixels(kHeights.bytes());
  read_pixels(png, kHeights, pixels);
  std::vector<std::uint16_t> codes(pixels.size() / 2);
  for (std::size_t i = 0; i < codes.size(); ++i) {
    codes[i] = static_cast<std::uint16_t>(pixels[2 * i] << 8 | pixels[2 * i + 1]);
  }
  return codes;
}

}  // namespace roadfix
