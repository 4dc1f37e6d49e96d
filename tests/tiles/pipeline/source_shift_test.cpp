#include "tiles/pipeline/source_shift.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "core/grid/resample.hpp"
#include "core/units/error.hpp"
#include "tests/support/code_of.hpp"
#include "tests/support/put_block.hpp"
#include "tests/support/sqlite_file.hpp"
#include "tests/support/street_map.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tiles/pipeline/ingest.hpp"
#include "tiles/pipeline/remove_source.hpp"
#include "tiles/store/map_reader.hpp"

namespace roadfix {
namespace {

using ::testing::_;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;

constexpr double kCellM = 2.0;

/// Nine tiles of a town, and what a source says of them whose georeference lies so many cells too far east and south.
SharedEvidence shared_evidence(int east, int south, std::uint64_t others_seed = 5) {
  constexpr int kTown = 3 * kTileCells + 200;
  const CellArray own = testing::street_map(5, {kCellM, {0, 0}, kTown, kTown}).cells;
  const CellArray others = testing::street_map(others_seed, {kCellM, {0, 0}, kTown, kTown}).cells;
  SharedEvidence result;
  for (int row = 0; row < 3; ++row) {
    for (int col = 0; col < 3; ++col) {
      const int west = 100 + kTileCells * col;
      const int north = 100 + kTileCells * row;
      SharedEvidence::Tile tile{CellArray(kTileCells, kTileCells), CellArray(kTileCells, kTileCells)};
      paste(own, tile.own, east - west, south - north);
      paste(others, tile.others, -west, -north);
      result.tiles.push_back(std::move(tile));
    }
  }
  return result;
}

TEST(SourceShift, IsWhereASourceFitsTheOthers) {
  const auto shift = shift_of(shared_evidence(12, -8), kCellM);
  ASSERT_TRUE(shift);
  EXPECT_EQ(shift->east_m, -24.0);
  EXPECT_EQ(shift->north_m, -16.0);
  EXPECT_GT(shift->correlation, 0.99);
  EXPECT_LT(shift->correlation_in_place, 0.5);
}

TEST(SourceShift, IsNoneWhereTheyAgreeOrHaveNothingInCommon) {
  EXPECT_FALSE(shift_of(shared_evidence(0, 0), kCellM));
  EXPECT_FALSE(shift_of(shared_evidence(1, -1), kCellM)) << "no more than a step";
  EXPECT_FALSE(shift_of(shared_evidence(0, 0, 6), kCellM)) << "another town";
  EXPECT_FALSE(shift_of({}, kCellM));
}

TEST(SourceShift, IsNoneThatMayGoOnBeyondTheShiftsThatWereTried) {
  EXPECT_TRUE(shift_of(shared_evidence(48, 0), kCellM));
  EXPECT_FALSE(shift_of(shared_evidence(50, 0), kCellM));
  EXPECT_FALSE(shift_of(shared_evidence(51, 0), kCellM));
  EXPECT_FALSE(shift_of(shared_evidence(0, -51), kCellM));
}

/// So many of the nine tiles lie in place, the others too far east.
SharedEvidence in_place_but(int in_place, int east) {
  SharedEvidence result = shared_evidence(east, 0);
  const SharedEvidence same = shared_evidence(0, 0);
  std::copy_n(same.tiles.begin(), in_place, result.tiles.begin());
  return result;
}

TEST(SourceShift, IsNoneThatFitsHardlyBetterThanTheSourceInItsPlace) {
  EXPECT_TRUE(shift_of(in_place_but(1, 4), kCellM));
  EXPECT_FALSE(shift_of(in_place_but(3, 4), kCellM));
}

TEST(SourceShift, StandsForARegistrationErrorWhoseEllipseOf95PercentHoldsTheOtherSide) {
  for (const int east : {6, 9, 20}) {
    const auto shift = shift_of(shared_evidence(east, 0), kCellM);
    ASSERT_TRUE(shift) << east;
    const double length_m = std::hypot(shift->east_m, shift->north_m);
    constexpr double kSigmasOf95 = 2.45;
    EXPECT_GT(kSigmasOf95 * shift->sigma_m, length_m);
    EXPECT_LT(2.0 * shift->sigma_m, length_m + 1e-9) << "and not much more";
  }
}

TEST(SourceShift, IsNoneThatTheRegistrationErrorsExplain) {
  SharedEvidence both = shared_evidence(12, 0);
  both.others_sigma_m = 8.0;
  both.own_sigma_m = 8.0;
  EXPECT_TRUE(shift_of(both, kCellM)) << "24 m, 2 sigma are 23 m";
  both.own_sigma_m = 9.0;
  EXPECT_FALSE(shift_of(both, kCellM));
}

TEST(SourceShift, HoldsWhereHalfOfTheGroundWasNotObserved) {
  SharedEvidence half = shared_evidence(12, 0);
  for (SharedEvidence::Tile& tile : half.tiles) {
    for (int row = 0; row < kTileCells; ++row) {
      for (int col = 0; col < kTileCells / 2; ++col) tile.own.at(col, row) = kUnobserved;
    }
  }
  const auto shift = shift_of(half, kCellM);
  ASSERT_TRUE(shift);
  EXPECT_EQ(shift->east_m, -24.0);
  EXPECT_EQ(shift->north_m, 0.0);
}

TEST(SourceShift, HasACorrelationOfOneAtMostWhereSquaresWereObservedInPart) {
  SharedEvidence striped = shared_evidence(12, -8);
  for (SharedEvidence::Tile& tile : striped.tiles) {
    for (int row = 0; row < kTileCells; row += 2) std::ranges::fill(tile.own.row(row), kUnobserved);
  }
  const auto shift = shift_of(striped, kCellM);
  ASSERT_TRUE(shift);
  EXPECT_GT(shift->correlation, 0.9);
  EXPECT_LE(shift->correlation, 1.0);
}

/// The source observed the west of the town, the others the east, and both a strip of so many columns.
SharedEvidence overlapping(int cols, int east, int south) {
  constexpr int kWest = 300;  // columns of the source
  SharedEvidence result = shared_evidence(east, south);
  for (std::size_t i = 0; i < result.tiles.size(); ++i) {
    const int first = static_cast<int>(i % 3) * kTileCells;
    for (int row = 0; row < kTileCells; ++row) {
      for (int col = 0; col < kTileCells; ++col) {
        if (first + col >= kWest) result.tiles[i].own.at(col, row) = kUnobserved;
        if (first + col < kWest - cols) result.tiles[i].others.at(col, row) = kUnobserved;
      }
    }
  }
  return result;
}

TEST(SourceShift, IsNoneOfANarrowOverlapThatFitsInPlace) {
  for (int cols = 4; cols <= 124; cols += 12) EXPECT_FALSE(shift_of(overlapping(cols, 0, 0), kCellM)) << cols;
}

TEST(SourceShift, IsNoneWhereTooLittleGroundIsSharedToTell) {
  EXPECT_FALSE(shift_of(overlapping(16, 12, -8), kCellM));
  EXPECT_FALSE(shift_of(overlapping(70, 12, -8), kCellM)) << "0.22 km^2";
  EXPECT_TRUE(shift_of(overlapping(100, 12, -8), kCellM));
}

/// One road from the west to the east, on every tile; that of the source lies so many cells to the north.
SharedEvidence one_road(int north) {
  SharedEvidence result;
  for (int i = 0; i < 9; ++i) {
    SharedEvidence::Tile tile{CellArray(kTileCells, kTileCells, kNoRoad), CellArray(kTileCells, kTileCells, kNoRoad)};
    for (int col = 0; col < kTileCells; ++col) {
      for (int row = 100; row < 104; ++row) {
        tile.own.at(col, row - north) = kRoad;
        tile.others.at(col, row) = kRoad;
      }
    }
    result.tiles.push_back(std::move(tile));
  }
  return result;
}

TEST(SourceShift, IsNoneThatASingleRoadTells) {
  EXPECT_FALSE(shift_of(one_road(12), kCellM)) << "how far along the road, nobody knows";
}

TEST(SourceShift, IsNoneOfRegularStreetsThatFitABlockAwayAsWell) {
  const CellArray blocks = testing::grid_city({kCellM, {0, 0}, 600, 600}, 60.0).cells;
  SharedEvidence city;
  city.tiles.push_back({CellArray(kTileCells, kTileCells), CellArray(kTileCells, kTileCells)});
  paste(blocks, city.tiles[0].own, -90, -100);
  paste(blocks, city.tiles[0].others, -100, -100);
  EXPECT_FALSE(shift_of(city, kCellM));
}

TEST(SourceShift, IsHardlyEverOneOfFewRoadsThatHaveNothingInCommon) {
  int shifts = 0;
  for (std::uint64_t seed = 100; seed < 108; ++seed) {
    for (SharedEvidence::Tile& tile : shared_evidence(0, 0, seed).tiles) {
      SharedEvidence one;
      one.tiles.push_back(std::move(tile));
      if (shift_of(one, kCellM)) ++shifts;
    }
  }
  EXPECT_LE(shifts, 1) << "of 72 overlaps of 0.26 km^2";
}

/// The part of the town that a tile shows of a source that lies so many cells too far east.
CellArray part_of(const CellArray& town, TileIndex tile, int east) {
  CellArray cells(kTileCells, kTileCells);
  paste(town, cells, east - 100 - kTileCells * (tile.col - 847), -100 - kTileCells * (tile.row + 8165));
  return cells;
}

/// Sources of four tiles of one town, each so many cells too far east.
class MeasuredShifts : public ::testing::Test {
 protected:
  MeasuredShifts() : writer(folder / "m.gpkg", {*UtmZone::from_epsg(32637), kCellM}) {}

  void put(const std::string& name, int east, double sigma_m = 2.5) {
    const SourceRecord record{.name = name,
                              .content = SourceContent::kRoads,
                              .fingerprint = name + std::to_string(east),
                              .provenance = {.registration_sigma_m = sigma_m}};
    put(record, {{847, -8165}, {848, -8165}, {847, -8164}, {848, -8164}}, town, east);
  }
  void put(const SourceRecord& record, const std::vector<TileIndex>& blocks, const CellArray& roads, int east) {
    for (const TileIndex block : writer.begin_source(record, blocks, true)) {
      testing::put_block(writer, record.name, block, part_of(roads, block, east));
    }
    writer.finish_source(record.name);
  }
  std::vector<SourceStatus> sources() const { return MapReader(folder / "m.gpkg").info().sources; }

  testing::TemporaryFolder folder;
  const CellArray town = testing::street_map(5, {kCellM, {0, 0}, 712, 712}).cells;
  MapWriter writer;
};

TEST_F(MeasuredShifts, OfTwoThatDifferBothCountAsUncertain) {
  put("a", 0);
  put("b", 10);
  const auto shifts = measure_shifts(writer, {"a", "b"}).beside;
  ASSERT_EQ(shifts.size(), 2U);
  EXPECT_EQ(shifts.at("b").shift.east_m, -20.0);
  EXPECT_EQ(shifts.at("a").shift.east_m, 20.0);
  for (const SourceStatus& source : sources()) {
    EXPECT_EQ(source.registration_sigma_m(), 10.0) << source.record.name;
    EXPECT_EQ(source.record.provenance.registration_sigma_m, 2.5);
  }
  EXPECT_EQ(measure_shifts(writer, {"a", "b"}).beside, shifts) << "what was measured before takes no part";
}

TEST_F(MeasuredShifts, OfThreeOnlyTheOneThatTwoContradictDoes) {
  put("a", 0);
  put("b", 10);
  put("c", 2);
  const ShiftReport report = measure_shifts(writer, {"a", "b", "c"});
  EXPECT_THAT(report.beside, ElementsAre(Pair("b", _)));
  EXPECT_THAT(report.copies, IsEmpty()) << "4 m apart";
}

TEST_F(MeasuredShifts, AreToldTheMapOnlyWhenAllAreMeasuredAndOutdatedUntilThen) {
  put("a", 0);
  put("b", 10);
  std::stop_source stop;
  const auto stop_after_one = [&](std::int64_t done, std::int64_t total) {
    EXPECT_EQ(total, 2);
    if (done == 1) stop.request_stop();
  };
  EXPECT_THROW(measure_shifts(writer, {"a", "b"}, stop_after_one, stop.get_token()), Interrupted);
  EXPECT_TRUE(writer.shifts_outdated());
  EXPECT_EQ(sources()[0].shift, std::nullopt);
}

TEST_F(MeasuredShifts, AreMeasuredAnewWhereASourceIsRemovedAlsoBySeveralTries) {
  put("a", 0);
  put("b", 10);
  ASSERT_EQ(measure_shifts(writer, {"a", "b"}).beside.size(), 2U);
  std::stop_source stop;
  const auto stop_at_once = [&](std::int64_t done, std::int64_t total) {
    if (done == total) stop.request_stop();
  };
  EXPECT_THROW(remove_source(writer, "b", stop_at_once, {}, stop.get_token()), Interrupted);
  EXPECT_EQ(sources()[0].registration_sigma_m(), 10.0);
  EXPECT_FALSE(remove_source(writer, "b", {}, {}, {}).was_there);
  EXPECT_EQ(sources()[0].registration_sigma_m(), 2.5);
  EXPECT_THROW(remove_source(writer, "b", {}, {}, {}), NotFound);
}

TEST_F(MeasuredShifts, OfAWrongSourceItsCopyAndARightOneAllThreeCountAsUncertain) {
  put("wrong", 10);
  put("copy", 10);
  put("right", 0);
  const ShiftReport report = measure_shifts(writer, {"wrong", "copy", "right"});
  EXPECT_THAT(report.copies, ElementsAre(Pair("copy", ElementsAre("wrong")), Pair("wrong", ElementsAre("copy"))));
  EXPECT_EQ(report.beside.size(), 3U);
  for (const SourceStatus& source : sources()) EXPECT_EQ(source.registration_sigma_m(), 10.0) << source.record.name;
}

TEST_F(MeasuredShifts, OfACopyOfAPartOfTheGroundCountTheSame) {
  const std::vector<TileIndex> west{{847, -8165}, {847, -8164}};
  put("wrong", 10);
  put({.name = "part",
       .content = SourceContent::kRoads,
       .fingerprint = "part",
       .provenance = {.registration_sigma_m = 2.5}},
      west, town, 10);
  put("right", 0);
  EXPECT_EQ(measure_shifts(writer, {"wrong", "part", "right"}).beside.size(), 3U);
}

TEST_F(MeasuredShifts, OfTwoThatContradictAThirdAndItsCopiesTheseAloneCountAsUncertain) {
  put("wrong", 10);
  put("copy", 10);
  put("another copy", 10);
  put("right", 0);
  put("right, too", 2);
  EXPECT_THAT(measure_shifts(writer, writer.sources_in_force()).beside,
              ElementsAre(Pair("another copy", _), Pair("copy", _), Pair("wrong", _)));
}

TEST_F(MeasuredShifts, OfCopiesThatOneStatesItsErrorExplainsWhatIsMeasuredOfTheOtherSide) {
  put("a", 0);
  put("b", 10);
  put("c", 10);
  ASSERT_EQ(measure_shifts(writer, writer.sources_in_force()).beside.size(), 3U);
  put("b", 10, 10.0);
  const auto shifts = measure_shifts(writer, writer.sources_in_force()).beside;
  EXPECT_THAT(shifts, ElementsAre(Pair("c", _))) << "that of b explains what a is beside";
}

TEST_F(MeasuredShifts, AreForgottenWhenTheSourceIsReplacedByOneThatFitsOrStatesItsError) {
  put("a", 0);
  put("b", 10);
  ASSERT_EQ(measure_shifts(writer, {"a", "b"}).beside.size(), 2U);
  put("b", 10, 10.0);
  EXPECT_TRUE(measure_shifts(writer, {"a", "b"}).beside.empty()) << "2 sigma explain it";
  EXPECT_EQ(sources()[0].registration_sigma_m(), 2.5);
  EXPECT_EQ(sources()[1].registration_sigma_m(), 10.0);
  put("b", 10, 2.5);
  ASSERT_EQ(measure_shifts(writer, {"a", "b"}).beside.size(), 2U);
  put("b", 0);
  EXPECT_TRUE(measure_shifts(writer, {"a", "b"}).beside.empty());
  EXPECT_EQ(sources()[0].registration_sigma_m(), 2.5);
}

/// Says nothing of a box.
class BlankSource : public CellSource {
 public:
  explicit BlankSource(GridBox extent) : extent_(extent) {}
  SourceSummary summary() const override { return {}; }
  GridBox extent() const override { return extent_; }
  bool touches(const GridBox& /*box*/) const override { return true; }
  CellArray read(const GridGeometry& block, std::uint64_t /*seed*/) const override { return {block.cols, block.rows}; }

 private:
  GridBox extent_;
};

TEST_F(MeasuredShifts, OfThoseBesideAReplacedSourceAreMeasuredAnewThoughFusingItsReplacementWasStopped) {
  put("a", 0);
  put("b", 10);
  ASSERT_EQ(measure_shifts(writer, {"a", "b"}).beside.size(), 2U);
  const SourceRecord elsewhere{.name = "b", .content = SourceContent::kRoads, .fingerprint = "elsewhere"};
  const BlankSource source(grown(tile_geometry({900, -8165}, kCellM).box(), -1.0));
  std::stop_source stop;
  const auto stop_at_once = [&](std::int64_t, std::int64_t) { stop.request_stop(); };
  EXPECT_EQ(testing::code_of([&] {
              ingest(source, elsewhere, writer, {.replace = true, .on_fusing = stop_at_once, .stop = stop.get_token()});
            }),
            "work-stopped");
  EXPECT_TRUE(ingest(source, elsewhere, writer, {.replace = true}).shifts.beside.empty());
  ASSERT_EQ(sources().size(), 2U);
  for (const SourceStatus& status : sources()) EXPECT_FALSE(status.shift) << status.record.name;
}

/// Says of a tile what it is given.
class TileSource final : public BlankSource {
 public:
  TileSource(TileIndex tile, CellArray cells)
      : BlankSource(grown(tile_geometry(tile, kCellM).box(), -1.0)), cells_(std::move(cells)) {}
  CellArray read(const GridGeometry& /*block*/, std::uint64_t /*seed*/) const override { return cells_; }

 private:
  CellArray cells_;
};

TEST_F(MeasuredShifts, OfThoseBesideANewSourceAreMeasuredAnew) {
  put("a", 0);
  ASSERT_TRUE(measure_shifts(writer, {"a"}).beside.empty());
  const TileIndex tile{847, -8165};
  const SourceRecord record{.name = "b", .content = SourceContent::kRoads, .fingerprint = "b"};
  const auto shifts = ingest(TileSource(tile, part_of(town, tile, 10)), record, writer, {}).shifts.beside;
  ASSERT_EQ(shifts.size(), 2U);
  EXPECT_EQ(shifts.at("b").shift.east_m, -20.0);
  EXPECT_EQ(shifts.at("a").shift.east_m, 20.0);
}

TEST_F(MeasuredShifts, StayAsTheyWereKnownWhereEvidenceIsDamagedAndItIsSaidWhich) {
  put("a", 0);
  put("b", 10);
  ASSERT_EQ(measure_shifts(writer, {"a", "b"}).beside.size(), 2U);
  testing::open_sqlite(folder / "m.gpkg")
      .execute(
          "UPDATE roadfix_evidence SET tile_data = zeroblob(50) WHERE tile_column = 848 AND source_id = (SELECT id "
          "FROM "
          "roadfix_sources WHERE name = 'a')");
  const ShiftReport report = measure_shifts(writer, {"a", "b"});
  EXPECT_THAT(report.beside, IsEmpty());
  EXPECT_THAT(report.notes, ElementsAre(AllOf(HasSubstr("whether 'a' or 'b' lies beside"), HasSubstr("m.gpkg"),
                                              HasSubstr("evidence of source 'a' column 848 row"))));
  ASSERT_EQ(sources().size(), 2U);
  for (const SourceStatus& status : sources()) EXPECT_TRUE(status.shift) << status.record.name;
}

}  // namespace
}  // namespace roadfix
