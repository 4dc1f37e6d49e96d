#include "tiles/store/tile_png.hpp"

#include <gmock/gmock.h>

#include "core/png/plain_png.hpp"
#include "core/units/error.hpp"
#include "tests/support/code_of.hpp"
#include "tests/support/png_of_rows.hpp"
#include "tests/tiles/store/map_fixture.hpp"

namespace roadfix {
namespace {

using testing::random_cells;

class TilePng : public ::testing::TestWithParam<TileDepth> {};

TEST_P(TilePng, ComesBackAsItWas) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const CellArray cells = random_cells(seed, {});
    EXPECT_EQ(decode_tile(encode_tile(cells, GetParam()), GetParam()), cells);
  }
  CellArray noise(kTileCells, kTileCells);
  std::mt19937_64 random(3);
  for (Cell& cell : noise.cells()) cell = static_cast<Cell>(random() % 256);
  EXPECT_EQ(decode_tile(encode_tile(noise, GetParam()), GetParam()), noise);
  for (const Cell fill : {kNoRoad, kRoad, kUnobserved}) {
    const CellArray cells(kTileCells, kTileCells, fill);
    EXPECT_EQ(decode_tile(encode_tile(cells, GetParam()), GetParam()), cells);
  }
}

TEST_P(TilePng, EqualCellsGiveEqualBytes) {
  EXPECT_EQ(encode_tile(random_cells(1, {}), GetParam()), encode_tile(random_cells(1, {}), GetParam()));
  const CellArray alike(kTileCells, kTileCells, kRoad);
  const auto png = encode_tile(alike, GetParam());
  EXPECT_EQ(encode_tile(alike, GetParam()), png);
  EXPECT_EQ(decode_tile(png, GetParam()), alike);
}

TEST_P(TilePng, ACutOffTileIsRefusedWhereverItEnds) {
  const auto png = encode_tile(CellArray(kTileCells, kTileCells, kRoad), GetParam());
  for (std::size_t size = 0; size < png.size(); ++size) {
    EXPECT_THROW(decode_tile(std::span(png).first(size), GetParam()), CorruptData) << size << " bytes";
  }
}

TEST_P(TilePng, AFlippedBitIsFound) {
  const auto png = encode_tile(CellArray(kTileCells, kTileCells, kRoad), GetParam());
  for (std::size_t i = 0; i < png.size(); ++i) {
    auto damaged = png;
    damaged[i] ^= std::byte{0x10};
    EXPECT_THROW(decode_tile(damaged, GetParam()), CorruptData) << "byte " << i;
  }
}

TEST_P(TilePng, TheOtherDepthIsRefused) {
  const TileDepth other = GetParam() == TileDepth::kFused ? TileDepth::kEvidence : TileDepth::kFused;
  EXPECT_THROW(decode_tile(encode_tile(random_cells(1, {}), other), GetParam()), CorruptData);
}

INSTANTIATE_TEST_SUITE_P(Depths, TilePng, ::testing::Values(TileDepth::kEvidence, TileDepth::kFused));

TEST(TilePngOfOthers, IsReadHoweverItsRowsAreStored) {
  constexpr testing::PngHeader kHeader{kTileCells, kTileCells, 8, 0, 0};
  constexpr char kDifferenceToLeft = 1;
  const std::string row = kDifferenceToLeft + std::string(1, '\x11') + std::string(kTileCells - 1, '\0');
  std::string rows;
  for (int i = 0; i < kTileCells; ++i) rows += row;
  EXPECT_EQ(decode_tile(testing::png_of_rows(kHeader, rows), TileDepth::kEvidence),
            CellArray(kTileCells, kTileCells, 0x11));
}

TEST(TilePngOfOthers, OfMoreThanOneTileIsRefused) {
  constexpr testing::PngHeader kHeader{kTileCells, kTileCells, 8, 0, 0};
  const std::string rows(std::size_t{kTileCells + 1} * kTileCells, '\0');
  const auto png = testing::png_of_rows(kHeader, rows + rows);
  EXPECT_EQ(testing::code_of([&] { decode_tile(png, TileDepth::kEvidence); }), "tile-corrupt");
}

TEST(TilePngDamage, BytesAfterTheEndAreRefused) {
  auto png = encode_tile(random_cells(1, {}), TileDepth::kFused);
  png.push_back(std::byte{0});
  EXPECT_THROW(decode_tile(png, TileDepth::kFused), CorruptData);
}

TEST(TilePngDamage, ValuesOfAFusedTileThatAreNoProbabilityAreRefused) {
  const auto code_of_value = [](unsigned value) {
    std::vector<std::uint8_t> pixels(std::size_t{2} * kTileCells * kTileCells);
    pixels[0] = static_cast<std::uint8_t>(value >> 8U);
    pixels[1] = static_cast<std::uint8_t>(value & 0xffU);
    const auto png = encode_plain_png(pixels, {kTileCells, kTileCells, 1, 16});
    return testing::code_of([&] { decode_tile(png, TileDepth::kFused); });
  };
  for (const unsigned value : {0U, 254U, 65535U}) EXPECT_EQ(code_of_value(value), "no error") << value;
  for (const unsigned value : {255U, 300U, 65534U}) EXPECT_EQ(code_of_value(value), "tile-corrupt") << value;
}

}  // namespace
}  // namespace roadfix
