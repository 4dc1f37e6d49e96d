#include "server/application.hpp"

#include <gtest/gtest.h>

#include "tests/support/captured_log.hpp"
#include "tests/support/eventually.hpp"
#include "tests/tiles/store/map_fixture.hpp"

namespace roadfix::server {
namespace {

void make_map_read_by(const std::string& reader, const std::filesystem::path& path) {
  SourceRecord record = roadfix::testing::TestSource{.name = "imagery", .seed = 1, .blocks = {}}.record();
  record.method = reader;
  MapWriter writer(path, roadfix::testing::settings_37n());
  for (const TileIndex block : writer.begin_source(record, roadfix::testing::some_blocks(1), false)) {
    roadfix::testing::put_block(writer, record.name, block, roadfix::testing::random_cells(1, block));
  }
  writer.finish_source(record.name);
}

TEST(Application, WarnsOfMapsOfAnotherDetectorAlsoWhereTheyComeWhileItServes) {
  const roadfix::testing::TemporaryFolder folder;
  const char* another = "neural x fnv1a64=1 gsd_m=1; 1";
  make_map_read_by(another, folder / "there.gpkg");
  Configuration configuration;
  configuration.maps = folder.path();
  configuration.watch_interval = std::chrono::milliseconds(10);
  configuration.http.port = 0;
  configuration.detector.name = "tree";
  const roadfix::testing::CapturedLog log;
  Application application(configuration);
  application.start();
  EXPECT_EQ(log.count("map there was read by neural x fnv1a64=1"), 1);
  make_map_read_by(another, folder / "later.gpkg");
  EXPECT_TRUE(roadfix::testing::eventually([&] { return log.count("map later was read by neural x") > 0; }));
  EXPECT_EQ(log.count("map there was read by"), 1) << "once";
}

}  // namespace
}  // namespace roadfix::server
