// What a map tells of sources that lie beside the others.
#include <gmock/gmock.h>

#include <array>
#include <optional>

#include "tests/tiles/store/map_fixture.hpp"
#include "tiles/store/map_verifier.hpp"

namespace roadfix {
namespace {

using testing::ingest;
using testing::settings_37n;
using testing::some_blocks;

constexpr SourceShift kShift{-12.0, 16.0, 0.6, 0.1, 10.0};

class ShiftTable : public ::testing::Test {
 protected:
  ShiftTable() : path(folder / "m.gpkg") {
    writer.emplace(path, settings_37n());
    ingest(*writer, {"a", 1, some_blocks(2)});
    ingest(*writer, {"b", 2, some_blocks(1, 1)});
    writer->put_shifts({{"a", std::nullopt}, {"b", kShift}, {"none", kShift}});
  }
  SourceStatus source(std::size_t i) const { return MapReader(path).info().sources.at(i); }
  /// Around the ground that b shares with a, and ground of a alone.
  std::array<double, 2> sigmas() const {
    const MapReader reader(path);
    const auto in = [&](TileIndex tile) {
      return reader.registration_sigma_m(grown(tile_geometry(tile, 2.0).box(), -10.0)).value();
    };
    return {in(some_blocks(1, 1).front()), in(some_blocks(1).front())};
  }

  testing::TemporaryFolder folder;
  std::filesystem::path path;
  std::optional<MapWriter> writer;
};

TEST_F(ShiftTable, WidensWhatCountsOnTheGroundOfTheSourceAndKeepsWhatItStates) {
  EXPECT_EQ(source(0).shift, std::nullopt);
  EXPECT_EQ(source(1).shift, kShift);
  EXPECT_EQ(source(1).record.provenance.registration_sigma_m, 2.5);
  EXPECT_EQ(source(1).registration_sigma_m(), 10.0);
  EXPECT_EQ(sigmas(), (std::array{10.0, 2.5}));
  EXPECT_EQ(provenance_of(MapReader(path).info()).registration_sigma_m, 10.0);
}

TEST_F(ShiftTable, NarrowsNothing) {
  writer->put_shifts({{"b", SourceShift{.east_m = 2.0, .sigma_m = 1.0}}});
  EXPECT_EQ(source(1).registration_sigma_m(), 2.5);
  EXPECT_EQ(sigmas(), (std::array{2.5, 2.5}));
}

TEST_F(ShiftTable, ForgetsASourceThatFitsAgainAndOneThatIsRemoved) {
  writer->put_shifts({{"b", std::nullopt}});
  EXPECT_EQ(source(1).shift, std::nullopt);
  writer->put_shifts({{"b", kShift}});
  writer->remove_source("b");
  sqlite::Connection map = testing::open_sqlite(path);
  EXPECT_EQ(sqlite::number(map, "SELECT count(*) FROM roadfix_shifts"), 0);
  ingest(*writer, {"b", 2, some_blocks(1, 1)});
  EXPECT_EQ(source(1).shift, std::nullopt);
}

TEST_F(ShiftTable, IsOutdatedFromAChangeOfTheSourcesInForceUntilTheyAreMeasured) {
  EXPECT_FALSE(writer->shifts_outdated());
  ingest(*writer, {"b", 2, some_blocks(1, 1)});
  EXPECT_FALSE(writer->shifts_outdated()) << "it is in force already";
  ingest(*writer, {"b", 3, some_blocks(1, 1)}, true);
  EXPECT_TRUE(writer->shifts_outdated());
  writer->put_shifts({});
  EXPECT_FALSE(writer->shifts_outdated());
  SourceRecord stated = testing::TestSource{"b", 3, {}}.record();
  stated.provenance.registration_sigma_m = 10.0;
  writer->begin_source(stated, some_blocks(1, 1), false);
  EXPECT_TRUE(writer->shifts_outdated());
  writer->put_shifts({});
  writer->remove_source("b");
  EXPECT_TRUE(writer->shifts_outdated());
  EXPECT_FALSE(writer->remove_source("b")) << "what should follow is still to be done";
  EXPECT_EQ(writer->sources_in_force(), std::set<std::string>{"a"});
}

TEST_F(ShiftTable, VerifyFindsErrorsThatNoShiftStandsFor) {
  for (const std::string sigma : {"0", "-10", "9e999", "'much'"}) {
    testing::open_sqlite(path).execute(("UPDATE roadfix_shifts SET sigma_m = " + sigma).c_str());
    const auto problems = verify_map(path).problems;
    ASSERT_EQ(problems.size(), 1U) << sigma;
    EXPECT_EQ(problems.front().code, "registration-wrong");
    EXPECT_THAT(problems.front().what, ::testing::HasSubstr("source 'b' is said to lie beside the others"));
  }
}

}  // namespace
}  // namespace roadfix
