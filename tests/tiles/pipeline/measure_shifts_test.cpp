// measure_shifts() on the sources of a map, and when it is called.
#include <gmock/gmock.h>

#include <cstdint>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "core/grid/cell_array.hpp"
#include "core/units/error.hpp"
#include "tests/support/code_of.hpp"
#include "tests/support/put_block.hpp"
#include "tests/support/sqlite_file.hpp"
#include "tests/support/street_map.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tiles/pipeline/ingest.hpp"
#include "tiles/pipeline/remove_source.hpp"
#include "tiles/pipeline/source_shift.hpp"
#include "tiles/store/map_reader.hpp"

namespace roadfix {
namespace {

using ::testing::_;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;

constexpr double kMapCellM = 2.0;

/// The part of the town that a tile shows of a source that lies so many cells too far east.
CellArray part_of(const CellArray& town, TileIndex tile, int east) {
  CellArray cells(kTileCells, kTileCells);
  paste(town, cells, east - 100 - kTileCells * (tile.col - 847), -100 - kTileCells * (tile.row + 8165));
  return cells;
}

/// Sources of four tiles of one town, each so many cells too far east.
class MeasuredShifts : public ::testing::Test {
 protected:
  MeasuredShifts() : writer(folder / "m.gpkg", {*UtmZone::from_epsg(32637), kMapCellM}) {}

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
  /// 20 m apart.
  void put_and_measure_a_and_b() {
    put("a", 0);
    put("b", 10);
    ASSERT_EQ(measure_shifts(writer, {"a", "b"}).shifted.size(), 2U);
  }
  std::vector<SourceStatus> sources() const { return MapReader(folder / "m.gpkg").info().sources; }

  testing::TemporaryFolder folder;
  const CellArray town = testing::street_map(5, {kMapCellM, {0, 0}, 712, 712}).cells;
  MapWriter writer;
};

TEST_F(MeasuredShifts, OfTwoThatDifferBothCountAsUncertain) {
  put("a", 0);
  put("b", 10);
  const auto shifts = measure_shifts(writer, {"a", "b"}).shifted;
  ASSERT_EQ(shifts.size(), 2U);
  EXPECT_EQ(shifts.at("b").shift.east_m, -20.0);
  EXPECT_EQ(shifts.at("a").shift.east_m, 20.0);
  for (const SourceStatus& source : sources()) {
    EXPECT_EQ(source.registration_sigma_m(), 10.0) << source.record.name;
    EXPECT_EQ(source.record.provenance.registration_sigma_m, 2.5);
  }
  EXPECT_EQ(measure_shifts(writer, {"a", "b"}).shifted, shifts) << "what was measured before takes no part";
}

TEST_F(MeasuredShifts, OfThreeOnlyTheOneThatTwoContradictDoes) {
  put("a", 0);
  put("b", 10);
  put("c", 2);
  const ShiftReport report = measure_shifts(writer, {"a", "b", "c"});
  EXPECT_THAT(report.shifted, ElementsAre(Pair("b", _)));
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
  put_and_measure_a_and_b();
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
  EXPECT_EQ(report.shifted.size(), 3U);
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
  EXPECT_EQ(measure_shifts(writer, {"wrong", "part", "right"}).shifted.size(), 3U);
}

TEST_F(MeasuredShifts, OfTwoThatContradictAThirdAndItsCopiesTheseAloneCountAsUncertain) {
  put("wrong", 10);
  put("copy", 10);
  put("another copy", 10);
  put("right", 0);
  put("right, too", 2);
  EXPECT_THAT(measure_shifts(writer, writer.sources_in_force()).shifted,
              ElementsAre(Pair("another copy", _), Pair("copy", _), Pair("wrong", _)));
}

TEST_F(MeasuredShifts, OfCopiesThatOneStatesItsErrorExplainsWhatIsMeasuredOfTheOtherSide) {
  put("a", 0);
  put("b", 10);
  put("c", 10);
  ASSERT_EQ(measure_shifts(writer, writer.sources_in_force()).shifted.size(), 3U);
  put("b", 10, 10.0);
  const auto shifts = measure_shifts(writer, writer.sources_in_force()).shifted;
  EXPECT_THAT(shifts, ElementsAre(Pair("c", _))) << "the error that b states explains the shift of a";
}

TEST_F(MeasuredShifts, AreForgottenWhenTheSourceIsReplacedByOneThatFitsOrStatesItsError) {
  put_and_measure_a_and_b();
  put("b", 10, 10.0);
  EXPECT_TRUE(measure_shifts(writer, {"a", "b"}).shifted.empty()) << "2 sigma explain it";
  EXPECT_EQ(sources()[0].registration_sigma_m(), 2.5);
  EXPECT_EQ(sources()[1].registration_sigma_m(), 10.0);
  put("b", 10, 2.5);
  ASSERT_EQ(measure_shifts(writer, {"a", "b"}).shifted.size(), 2U);
  put("b", 0);
  EXPECT_TRUE(measure_shifts(writer, {"a", "b"}).shifted.empty());
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

TEST_F(MeasuredShifts, OfThoseOnTheGroundOfAReplacedSourceAreMeasuredAnewThoughFusingItsReplacementWasStopped) {
  put_and_measure_a_and_b();
  const SourceRecord elsewhere{.name = "b", .content = SourceContent::kRoads, .fingerprint = "elsewhere"};
  const BlankSource source(grown(tile_geometry({900, -8165}, kMapCellM).box(), -1.0));
  std::stop_source stop;
  const auto stop_at_once = [&](std::int64_t, std::int64_t) { stop.request_stop(); };
  EXPECT_EQ(testing::code_of([&] {
              ingest(source, elsewhere, writer, {.replace = true, .on_fusing = stop_at_once, .stop = stop.get_token()});
            }),
            "work-stopped");
  EXPECT_TRUE(ingest(source, elsewhere, writer, {.replace = true}).shifts.shifted.empty());
  ASSERT_EQ(sources().size(), 2U);
  for (const SourceStatus& status : sources()) EXPECT_FALSE(status.shift) << status.record.name;
}

/// Says of a tile what it is given.
class TileSource final : public BlankSource {
 public:
  TileSource(TileIndex tile, CellArray cells)
      : BlankSource(grown(tile_geometry(tile, kMapCellM).box(), -1.0)), cells_(std::move(cells)) {}
  CellArray read(const GridGeometry& /*block*/, std::uint64_t /*seed*/) const override { return cells_; }

 private:
  CellArray cells_;
};

TEST_F(MeasuredShifts, OfThoseOnTheGroundOfANewSourceAreMeasuredAnew) {
  put("a", 0);
  ASSERT_TRUE(measure_shifts(writer, {"a"}).shifted.empty());
  const TileIndex tile{847, -8165};
  const SourceRecord record{.name = "b", .content = SourceContent::kRoads, .fingerprint = "b"};
  const auto shifts = ingest(TileSource(tile, part_of(town, tile, 10)), record, writer, {}).shifts.shifted;
  ASSERT_EQ(shifts.size(), 2U);
  EXPECT_EQ(shifts.at("b").shift.east_m, -20.0);
  EXPECT_EQ(shifts.at("a").shift.east_m, 20.0);
}

TEST_F(MeasuredShifts, StayAsTheyWereKnownWhereEvidenceIsDamagedAndItIsSaidWhich) {
  put_and_measure_a_and_b();
  testing::open_sqlite(folder / "m.gpkg")
      .execute(
          "UPDATE roadfix_evidence SET tile_data = zeroblob(50) WHERE tile_column = 848 AND source_id = "
          "(SELECT id FROM roadfix_sources WHERE name = 'a')");
  const ShiftReport report = measure_shifts(writer, {"a", "b"});
  EXPECT_THAT(report.shifted, IsEmpty());
  EXPECT_THAT(report.notes, ElementsAre(AllOf(HasSubstr("whether 'a' or 'b' lies beside"), HasSubstr("m.gpkg"),
                                              HasSubstr("evidence of source 'a' column 848 row"))));
  ASSERT_EQ(sources().size(), 2U);
  for (const SourceStatus& status : sources()) EXPECT_TRUE(status.shift) << status.record.name;
}

}  // namespace
}  // namespace roadfix
