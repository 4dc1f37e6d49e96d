// What the sources of a map say, beside each other.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <string>

#include "tests/tiles/store/map_fixture.hpp"
#include "tiles/store/fusion.hpp"
#include "tiles/store/map_writer.hpp"

namespace roadfix {
namespace {

using testing::ingest;
using testing::random_cells;
using testing::settings_37n;
using testing::some_blocks;
using testing::TemporaryFolder;
using testing::TestSource;

TEST(EvidenceTable, FindsSourcesThatSayTheSame) {
  const TemporaryFolder folder;
  MapWriter writer(folder / "m.gpkg", settings_37n());
  ingest(writer, {"a", 1, some_blocks(2)});
  EXPECT_TRUE(writer.twins_of("a").empty());
  ingest(writer, {"another", 2, some_blocks(2)});
  EXPECT_TRUE(writer.twins_of("another").empty());
  ingest(writer, {"copy", 1, some_blocks(2)});
  EXPECT_EQ(writer.twins_of("copy"), std::vector<std::string>{"a"});
  ingest(writer, {"part", 2, some_blocks(1)});
  EXPECT_EQ(writer.twins_of("part"), std::vector<std::string>{"another"});
  EXPECT_TRUE(writer.twins_of("another").empty());
  ingest(writer, {"more", 1, some_blocks(3)});
  EXPECT_TRUE(writer.twins_of("more").empty());
}

/// By this process, into files and elsewhere; 0 where the system does not say.
std::int64_t bytes_written() {
  std::ifstream counts("/proc/self/io");
  std::int64_t bytes = 0;
  for (std::string name; counts >> name >> bytes;) {
    if (name == "wchar:") return bytes;
  }
  return 0;
}

TEST(EvidenceTable, LooksForSourcesThatSayTheSameWithoutACopyOfAllThatOneSays) {
  const TemporaryFolder folder;
  MapWriter writer(folder / "m.gpkg", settings_37n());
  ingest(writer, {"a", 1, some_blocks(1)});
  ingest(writer, {"b", 2, some_blocks(1)});
  testing::open_sqlite(folder / "m.gpkg")
      .execute(
          "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < 2000) INSERT INTO roadfix_evidence "
          "(source_id, tile_column, tile_row, tile_data) SELECT s.id, i, 0, randomblob(9000) FROM n, roadfix_sources "
          "s");
  const std::int64_t before = bytes_written();
  if (before == 0) GTEST_SKIP() << "the system does not count what is written";
  EXPECT_TRUE(writer.twins_of("a").empty());
  EXPECT_LT(bytes_written() - before, 1'000'000);
}

TEST(EvidenceTable, ComparesASourceWithWitnessesInForceWhereBothSaySomething) {
  const TemporaryFolder folder;
  MapWriter writer(folder / "m.gpkg", settings_37n());
  const std::vector<Witness> witnesses{{"b"}, {"c"}, {"unfinished"}};
  ingest(writer, {"a", 1, some_blocks(3)});
  EXPECT_TRUE(writer.shared_evidence("a", witnesses, 9).tiles.empty()) << "there is no other";
  ingest(writer, {"b", 2, some_blocks(3, 1)});
  ingest(writer, {"c", 3, some_blocks(1, 1)});
  writer.begin_source(TestSource{"unfinished", 4, some_blocks(1)}.record(), some_blocks(1), false);
  const SharedEvidence all = writer.shared_evidence("a", witnesses, 9);
  const std::vector<TileIndex> shared = some_blocks(2, 1);
  ASSERT_EQ(all.tiles.size(), shared.size());
  EXPECT_EQ(all.own_sigma_m, 2.5);
  EXPECT_EQ(all.others_sigma_m, 2.5);
  for (const TileIndex block : shared) {
    std::vector<CellArray> others{random_cells(2, block)};
    if (block == some_blocks(1, 1).front()) others.push_back(random_cells(3, block));
    EXPECT_TRUE(std::ranges::any_of(all.tiles,
                                    [&](const SharedEvidence::Tile& tile) {
                                      return tile.own == random_cells(1, block) && tile.others == fused(others);
                                    }))
        << block.col << ' ' << block.row;
  }
  EXPECT_EQ(writer.shared_evidence("a", witnesses, 2).tiles.size(), 2U);
  EXPECT_TRUE(writer.shared_evidence("none", witnesses, 2).tiles.empty());
}

TEST(EvidenceTable, HasAWitnessOfSeveralSourcesSpeakOnce) {
  const TemporaryFolder folder;
  MapWriter writer(folder / "m.gpkg", settings_37n());
  const std::vector<TileIndex> block = some_blocks(1);
  for (std::uint64_t seed = 1; seed <= 4; ++seed) ingest(writer, {std::string(1, "_abcd"[seed]), seed, block});
  const std::vector<Witness> witnesses{{"b"}, {"c", "d"}};
  const SharedEvidence shared = writer.shared_evidence("a", witnesses, 9);
  ASSERT_EQ(shared.tiles.size(), 1U);
  const CellArray one = fused(std::vector{random_cells(3, block[0]), random_cells(4, block[0])});
  EXPECT_EQ(shared.tiles[0].others, fused(std::vector{random_cells(2, block[0]), one}));
}

TEST(EvidenceTable, NamesTheOtherSourcesInForceOfTheSameTiles) {
  const TemporaryFolder folder;
  MapWriter writer(folder / "m.gpkg", settings_37n());
  ingest(writer, {"a", 1, some_blocks(2)});
  ingest(writer, {"b", 2, some_blocks(2, 1)});
  ingest(writer, {"far", 3, some_blocks(1, 5)});
  writer.begin_source(TestSource{"unfinished", 4, some_blocks(1)}.record(), some_blocks(1), false);
  EXPECT_EQ(writer.sources_sharing_ground("a"), std::vector<std::string>{"b"});
  EXPECT_EQ(writer.sources_sharing_ground("b"), std::vector<std::string>{"a"});
  EXPECT_TRUE(writer.sources_sharing_ground("far").empty());
  EXPECT_TRUE(writer.sources_sharing_ground("unfinished").empty());
}

}  // namespace
}  // namespace roadfix
