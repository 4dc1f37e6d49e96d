#include "tiles/store/map_verifier.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "core/units/error.hpp"
#include "tests/tiles/store/map_fixture.hpp"

namespace roadfix {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::ingest;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::settings_37n;
using testing::some_blocks;
using testing::TemporaryFolder;

class MapVerifier : public ::testing::Test {
 protected:
  MapVerifier() : path(folder / "m.gpkg") {
    MapWriter writer(path, settings_37n());
    ingest(writer, {"a", 1, some_blocks(2)});
    ingest(writer, {"b", 2, some_blocks(1)});
  }

  std::vector<std::string> codes_after(const char* sql) {
    testing::open_sqlite(path).execute(sql);
    std::vector<std::string> codes;
    for (const MapProblem& problem : verify_map(path).problems) codes.push_back(problem.code);
    return codes;
  }

  TemporaryFolder folder;
  fs::path path;
};

TEST_F(MapVerifier, AWholeMapHasNoProblems) {
  std::int64_t last_done = 0;
  std::int64_t last_total = 0;
  const MapVerdict verdict = verify_map(path, [&](std::int64_t done, std::int64_t total) {
    last_done = done;
    last_total = total;
  });
  EXPECT_THAT(verdict.problems, IsEmpty());
  EXPECT_EQ(verdict.evidence, 5);
  EXPECT_EQ(last_done, verdict.tiles + verdict.evidence);
  EXPECT_EQ(last_done, last_total);
}

TEST_F(MapVerifier, AnEmptyMapIsWhole) {
  { MapWriter writer(folder / "empty.gpkg", settings_37n()); }
  EXPECT_THAT(verify_map(folder / "empty.gpkg").problems, IsEmpty());
}

TEST_F(MapVerifier, NamesAnIngestThatWasInterruptedThoughTheMapIsWhole) {
  const TileIndex block{847, -8165};
  {
    MapWriter writer(path, settings_37n());
    writer.begin_source(testing::TestSource{"c", 3, {}}.record(), std::vector{block}, false);
  }
  const MapVerdict verdict = verify_map(path);
  EXPECT_THAT(verdict.problems, IsEmpty());
  ASSERT_EQ(verdict.unfinished.size(), 1U);
  EXPECT_EQ(verdict.unfinished[0].record.name, "c");
  EXPECT_EQ(verdict.unfinished[0].blocks_done, 0);
  EXPECT_EQ(verdict.unfinished[0].blocks_total, 1);
}

TEST_F(MapVerifier, NamesACorruptTile) {
  EXPECT_THAT(
      codes_after("UPDATE road_probability SET tile_data = x'00' WHERE zoom_level = 11 AND tile_column = 848 AND "
                  "tile_row = 12315"),
      ElementsAre("tile-corrupt"));
  EXPECT_THAT(verify_map(path).problems.front().what, HasSubstr("zoom 11 column 848 row 12315"));
}

TEST_F(MapVerifier, NamesCorruptEvidence) {
  EXPECT_THAT(codes_after("UPDATE roadfix_evidence SET tile_data = x'00' WHERE tile_column = 848"),
              ElementsAre("evidence-corrupt", "evidence-corrupt"));
  EXPECT_THAT(verify_map(path).problems.front().what, HasSubstr("source 'a' column 848"));
}

TEST_F(MapVerifier, FindsTilesThatDoNotFollowFromTheEvidence) {
  EXPECT_THAT(codes_after("UPDATE road_probability SET tile_data = (SELECT tile_data FROM road_probability WHERE "
                          "zoom_level = 10 LIMIT 1) WHERE zoom_level = 11 AND tile_column = 848 AND tile_row = 12315"),
              ElementsAre("tile-not-fused", "overview-differs"));
}

TEST_F(MapVerifier, FindsMissingTilesAndRowsLeftOver) {
  // Two tiles of that level, and the one above that no longer follows.
  EXPECT_THAT(codes_after("DELETE FROM road_probability WHERE zoom_level = 7"),
              ElementsAre("ancillary-wrong", "overview-differs", "overview-differs", "overview-differs"));
}

TEST_F(MapVerifier, FindsWrongScales) {
  EXPECT_THAT(codes_after("UPDATE gpkg_2d_gridded_tile_ancillary SET scale = 2 WHERE id = 1"),
              ElementsAre("ancillary-wrong"));
}

TEST_F(MapVerifier, DoesNotMindTheTilesOfOtherPrograms) {
  EXPECT_THAT(codes_after("INSERT INTO gpkg_contents (table_name, data_type, identifier, srs_id) VALUES ('heights', "
                          "'2d-gridded-coverage', 'heights', 32637); INSERT INTO gpkg_2d_gridded_tile_ancillary "
                          "(tpudt_name, tpudt_id, scale) VALUES ('heights', 999, 0.5)"),
              IsEmpty());
}

TEST_F(MapVerifier, FindsADescriptionByWhichOtherProgramsMisreadTheMap) {
  for (const std::string change : {"scale = 1.0", "offset = 0.5", "data_null = 0", "data_null = NULL",
                                   "datatype = 'float'", "grid_cell_encoding = 'grid-value-is-center'"}) {
    const fs::path copy = folder / "copy.gpkg";
    fs::copy_file(path, copy, fs::copy_options::overwrite_existing);
    testing::open_sqlite(copy).execute(("UPDATE gpkg_2d_gridded_coverage_ancillary SET " + change).c_str());
    const std::vector<MapProblem> problems = verify_map(copy).problems;
    ASSERT_EQ(problems.size(), 1U) << change;
    EXPECT_EQ(problems.front().code, "coverage-wrong") << change;
  }
  EXPECT_THAT(codes_after("DELETE FROM gpkg_2d_gridded_coverage_ancillary"), ElementsAre("coverage-wrong"));
}

TEST_F(MapVerifier, FindsAReferenceByWhichOtherProgramsShowTheMapElsewhere) {
  const char* const another_meridian = R"(gpkg_spatial_ref_sys
      SET definition = replace(definition, '"central_meridian",39', '"central_meridian",33') WHERE srs_id = 32637)";
  for (const std::string change :
       {"gpkg_contents SET srs_id = 4326", "gpkg_contents SET data_type = 'tiles'",
        "gpkg_spatial_ref_sys SET organization_coordsys_id = 32636 WHERE srs_id = 32637",
        "gpkg_spatial_ref_sys SET organization = 'NONE' WHERE srs_id = 32637", another_meridian}) {
    const fs::path copy = folder / "copy.gpkg";
    fs::copy_file(path, copy, fs::copy_options::overwrite_existing);
    testing::open_sqlite(copy).execute(("UPDATE " + change).c_str());
    const std::vector<MapProblem> problems = verify_map(copy).problems;
    ASSERT_EQ(problems.size(), 1U) << change;
    EXPECT_EQ(problems.front().code, "reference-wrong") << change;
  }
}

TEST_F(MapVerifier, FindsRegistrationErrorsThatNoSourceHas) {
  for (const std::string sigma : {"0", "-2.5", "9e999", "'much'"}) {
    const std::string change = "UPDATE roadfix_sources SET registration_sigma_m = " + sigma;
    EXPECT_THAT(codes_after(change.c_str()), ElementsAre("registration-wrong", "registration-wrong")) << sigma;
  }
  EXPECT_THAT(verify_map(path).problems.front().what, HasSubstr("source 'a' states a registration error of much m"));
}

TEST_F(MapVerifier, FindsABrokenLedger) {
  EXPECT_THAT(codes_after("UPDATE roadfix_blocks SET done = 0 WHERE tile_column = 848"),
              ElementsAre("ledger-broken", "ledger-broken"));
}

TEST_F(MapVerifier, FindsAWrongLatticeExtentAndVersion) {
  EXPECT_THAT(codes_after("UPDATE gpkg_contents SET min_x = 0"), ElementsAre("extent-wrong"));
  EXPECT_THAT(codes_after("UPDATE roadfix_meta SET value = '0' WHERE key = 'version'"),
              ElementsAre("extent-wrong", "version-wrong"));
  EXPECT_THAT(codes_after("UPDATE gpkg_tile_matrix SET pixel_x_size = 3"), ElementsAre("lattice-wrong"));
}

TEST_F(MapVerifier, FindsTilesOutsideTheLattice) {
  EXPECT_THAT(codes_after("UPDATE road_probability SET tile_column = 4294967296 + 7 WHERE id = 1"),
              Contains("tile-outside-lattice"));
}

TEST_F(MapVerifier, FindsWaitingTilesThatNoWriterMadeAndRepairGoesOnWithoutThem) {
  const auto before = testing::tile_bytes(path);
  EXPECT_THAT(codes_after("INSERT INTO roadfix_pending VALUES (40, 1, 1), (11, -1, 1), (11, 1, 4294967297)"),
              ElementsAre("tile-outside-lattice", "tile-outside-lattice", "tile-outside-lattice"));
  EXPECT_THAT(MapWriter(path, settings_37n()).repair(), IsEmpty());
  EXPECT_THAT(verify_map(path).problems, IsEmpty());
  EXPECT_EQ(verify_map(path).tiles_to_fuse, 0);
  EXPECT_EQ(testing::tile_bytes(path), before);
}

TEST_F(MapVerifier, CountsWhatAnInterruptedFusionLeftAndCallsItNoDamage) {
  EXPECT_THAT(codes_after("INSERT INTO roadfix_pending VALUES (11, 12315, 848); UPDATE gpkg_contents SET min_x = NULL, "
                          "min_y = NULL, max_x = NULL, max_y = NULL"),
              IsEmpty())
      << "the extent is written last";
  EXPECT_EQ(verify_map(path).tiles_to_fuse, 1);
}

TEST_F(MapVerifier, FindsDamageToTheDatabaseItself) {
  // Overwrites pages in the middle of the file with noise; whatever SQLite calls it, it must be said.
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(static_cast<std::streamoff>(fs::file_size(path) / 2 / 4096 * 4096));
  file << std::string(20UL * 4096UL, '\x5a');
  file.close();
  try {
    EXPECT_FALSE(verify_map(path).problems.empty());
  } catch (const CorruptData& error) {
    EXPECT_EQ(error.code(), "map-corrupt");
  }
}

TEST_F(MapVerifier, RepairMakesTheTilesAnewFromTheEvidence) {
  const auto before = testing::tile_bytes(path);
  const std::string version = MapReader(path).info().version;
  EXPECT_THAT(codes_after("UPDATE road_probability SET tile_data = x'00' WHERE id % 3 = 1;"
                          "DELETE FROM road_probability WHERE id = 2;"
                          "UPDATE roadfix_meta SET value = 'beef' WHERE key = 'version'"),
              Not(IsEmpty()));
  EXPECT_THAT(MapWriter(path, settings_37n()).repair(), IsEmpty());
  EXPECT_THAT(verify_map(path).problems, IsEmpty());
  EXPECT_EQ(testing::tile_bytes(path), before);
  EXPECT_EQ(MapReader(path).info().version, version);
}

TEST_F(MapVerifier, RepairNamesTheSourceThatLostEvidenceAndIngestingItAgainHealsTheMap) {
  const auto before = testing::tile_bytes(path);
  testing::open_sqlite(path).execute(
      "UPDATE roadfix_evidence SET tile_data = x'00' WHERE id = (SELECT max(id) FROM roadfix_evidence)");
  MapWriter writer(path, settings_37n());
  writer.put_shifts({});
  EXPECT_THAT(writer.repair(), ElementsAre("b"));
  EXPECT_TRUE(writer.shifts_outdated());
  EXPECT_THAT(verify_map(path).problems, ElementsAre(::testing::Field(&MapProblem::code, "ledger-broken")));
  const testing::TestSource lost{"b", 2, some_blocks(1)};
  EXPECT_THROW(writer.begin_source(lost.record(), lost.blocks, false), InvalidInput);
  ingest(writer, lost, true);
  EXPECT_THAT(verify_map(path).problems, IsEmpty());
  EXPECT_EQ(testing::tile_bytes(path), before);
}

TEST_F(MapVerifier, RepairDropsEvidenceThatTheLedgerDoesNotKnowAndNamesItsSource) {
  EXPECT_THAT(
      codes_after("DELETE FROM roadfix_blocks WHERE source_id = (SELECT id FROM roadfix_sources WHERE name = 'a') "
                  "AND tile_column = 848"),
      ElementsAre("ledger-broken"));
  MapWriter writer(path, settings_37n());
  EXPECT_THAT(writer.repair(), ElementsAre("a"));
  EXPECT_THAT(verify_map(path).problems, IsEmpty());
  EXPECT_EQ(verify_map(path).evidence, 3);
}

TEST_F(MapVerifier, LetsWritersInWhileItReads) {
  MapWriter writer(path, settings_37n());
  int writes = 0;
  const auto write = [&](std::int64_t, std::int64_t) {
    sqlite::Connection other = testing::open_sqlite(path);
    other.execute("PRAGMA busy_timeout = 0; UPDATE roadfix_sources SET licence = licence || 'x'");
    ++writes;
  };
  EXPECT_THROW(verify_map(path, write), InUse) << "the map has changed under it";
  EXPECT_GT(writes, 5);
}

TEST_F(MapVerifier, CanBeStopped) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(verify_map(path, {}, stop.get_token()), Interrupted);
}

}  // namespace
}  // namespace roadfix
