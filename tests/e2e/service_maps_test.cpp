// The maps that a service serves: as they come, change and go, and as their places are judged.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cstdint>
#include <fstream>
#include <vector>

#include "core/locate/calibration.hpp"
#include "core/units/error.hpp"
#include "tests/e2e/service_fixture.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/sqlite_file.hpp"
#include "tests/tiles/store/map_fixture.hpp"
#include "tiles/mercator/web_mercator.hpp"

namespace roadfix {
namespace {

using nlohmann::json;
using testing::eventually;
using ::testing::HasSubstr;

TEST(ServiceMaps, NoticesMapsThatAppearChangeBreakAndLeave) {
  const testing::TemporaryFolder folder;
  const testing::ServiceProcess service(folder.path());
  httplib::Client client = testing::client_of(service);
  const testing::Town town;
  const auto status = [&] {
    const json maps = testing::json_of(client.Get("/v1/maps"))["maps"];
    return maps.empty() ? "none" : maps[0]["status"].get<std::string>();
  };
  EXPECT_EQ(status(), "none");
  EXPECT_THAT(client.Get("/metrics")->body, HasSubstr("roadfix_maps_unreadable 0\n"));

  testing::write_map_file(folder / "town.gpkg", town.roads, 2.0);
  EXPECT_TRUE(eventually([&] { return status() == "ready"; }));
  const std::string version = testing::json_of(client.Get("/v1/maps/town"))["version"];
  const auto tiles = [&] { return testing::json_of(client.Get("/v1/maps/town/tilejson.json"))["tiles"]; };
  const json tiles_before = tiles();

  {
    MapWriter writer(folder / "town.gpkg", {town.zone, 2.0});
    writer.remove_source("town");
  }
  EXPECT_TRUE(eventually([&] { return testing::json_of(client.Get("/v1/maps/town"))["version"] != version; }));
  EXPECT_NE(tiles(), tiles_before) << "a client that keeps tiles gets new ones by their new addresses";

  std::ofstream(folder / "broken.gpkg") << "no map at all";
  EXPECT_TRUE(eventually([&] { return status() == "unreadable"; })) << "the broken one is listed, first by name";
  EXPECT_THAT(client.Get("/metrics")->body, HasSubstr("roadfix_maps_unreadable 1\n"));
  EXPECT_EQ(testing::refusal(client.Get("/v1/maps/broken")), "503 map-unreadable");
  EXPECT_EQ(client.Get("/v1/maps/town")->status, 200) << "the other one is served";

  std::filesystem::remove(folder / "broken.gpkg");
  std::filesystem::remove(folder / "town.gpkg");
  EXPECT_TRUE(eventually([&] { return status() == "none"; }));
}

TEST(ServiceMaps, SaysThatTheirFolderIsGoneAndServesWhatItHas) {
  const testing::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "maps");
  testing::write_map_file(folder / "maps" / "town.gpkg", testing::Town().roads, 2.0);
  const testing::ServiceProcess service(folder / "maps");
  httplib::Client client = testing::client_of(service);
  const auto problem = [&] { return testing::json_of(client.Get("/readyz")).value("maps_problem", ""); };
  EXPECT_EQ(problem(), "");
  EXPECT_THAT(client.Get("/metrics")->body, HasSubstr("roadfix_maps_folder_readable 1\n"));

  std::filesystem::rename(folder / "maps", folder / "away");
  EXPECT_TRUE(eventually([&] { return !problem().empty(); }));
  EXPECT_THAT(client.Get("/metrics")->body, HasSubstr("roadfix_maps_folder_readable 0\n"));
  EXPECT_EQ(client.Get("/v1/maps/town")->status, 200);

  std::filesystem::rename(folder / "away", folder / "maps");
  EXPECT_TRUE(eventually([&] { return problem().empty(); }));
}

TEST(ServiceMaps, AMapWithoutLatitudeAndLongitudeHidesNoOther) {
  const testing::TemporaryFolder folder;
  const testing::Town town;
  testing::write_map_file(folder / "far.gpkg", town.roads, 2.0);
  testing::write_map_file(folder / "town.gpkg", town.roads, 2.0);
  testing::open_sqlite(folder / "far.gpkg").execute("UPDATE gpkg_contents SET max_x = 1.04e6");
  const testing::ServiceProcess service(folder.path());
  httplib::Client client = testing::client_of(service);
  const json maps = testing::json_of(client.Get("/v1/maps"))["maps"];
  ASSERT_EQ(maps.size(), 2U);
  EXPECT_EQ(maps[0]["status"], "unreadable");
  EXPECT_EQ(maps[0]["code"], "position-outside-zone");
  EXPECT_EQ(maps[1]["status"], "ready");
}

TEST(ServiceMaps, SaysWhereAMapLacksBlocks) {
  const testing::TemporaryFolder folder;
  const testing::Town town;
  testing::write_map_file(folder / "town.gpkg", town.roads, 2.0);
  testing::open_sqlite(folder / "town.gpkg")
      .execute(
          "UPDATE roadfix_blocks SET done = 0 WHERE (tile_row, tile_column) IN (SELECT tile_row, tile_column FROM "
          "roadfix_blocks LIMIT 1)");
  const testing::ServiceProcess service(folder.path());
  httplib::Client client = testing::client_of(service);
  EXPECT_EQ(testing::json_of(client.Get("/v1/maps"))["maps"][0]["status"], "damaged");
  const json map = testing::json_of(client.Get("/v1/maps/town"));
  EXPECT_EQ(map["status"], "damaged");
  const json& source = map["sources"][0];
  EXPECT_EQ(source["complete"], false);
  EXPECT_EQ(source["blocks_done"], source["blocks_total"].get<int>() - 1);
}

TEST(ServiceMaps, TellsTheHeightsOfTheGroundOnceAMapHasThemAndKeepsItsVersion) {
  const testing::TemporaryFolder folder;
  const testing::Town town;
  testing::write_map_file(folder / "town.gpkg", town.roads, 2.0);
  const testing::ServiceProcess service(folder.path());
  httplib::Client client = testing::client_of(service);
  const json before = testing::json_of(client.Get("/v1/maps/town"));
  EXPECT_FALSE(before.contains("terrain"));
  MapWriter writer(folder / "town.gpkg", {town.zone, 2.0});
  const GridPoint centre = writer.extent().centre();
  writer.put_terrain({GridGeometry::covering({centre, centre}, 32.0).padded(1), std::vector<std::uint16_t>(9, 6000)},
                     {.location = "heights.tif", .provenance = {.licence = "free", .attribution = "DLR e.V."}});
  const auto terrain = [&] { return testing::json_of(client.Get("/v1/maps/town")).value("terrain", json()); };
  EXPECT_TRUE(eventually([&] { return !terrain().is_null(); }));
  EXPECT_EQ(terrain()["lowest_m"], 200.0);
  EXPECT_EQ(terrain()["attribution"], "DLR e.V.");
  EXPECT_FALSE(terrain().contains("location")) << "where files lie is nobody's business";
  const json listed = testing::json_of(client.Get("/v1/maps"))["maps"][0];
  EXPECT_EQ(listed["terrain"], terrain());
  EXPECT_EQ(listed["version"], before["version"]);
  writer.remove_terrain();
  EXPECT_TRUE(eventually([&] { return terrain().is_null(); }));
}

TEST(ServiceMaps, DescribesTilesAcrossThe180thMeridianWithinTheBoundsOfTileJson) {
  const testing::TemporaryFolder folder;
  const auto zone = UtmZone::from_epsg(32760).value();
  // 820 km east and 8140 km north are 16.8 degrees south on the 180th meridian.
  testing::write_map_file(folder / "taveuni.gpkg", testing::street_map(41, {2.0, {409'850, -4'070'150}, 300, 300}), 2.0,
                          zone);
  const testing::ServiceProcess service(folder.path());
  httplib::Client client = testing::client_of(service);
  const json bbox = testing::json_of(client.Get("/v1/maps/taveuni"))["bbox"];
  ASSERT_LT(bbox[0], 180.0);
  ASSERT_GT(bbox[2], 180.0);
  for (const char* path : {"/v1/maps/taveuni/tilejson.json", "/v1/maps/taveuni/localizability/tilejson.json"}) {
    const json tiles = testing::json_of(client.Get(path));
    EXPECT_EQ(tiles["bounds"], json({-180.0, bbox[1], 180.0, bbox[3]})) << path;
  }
  const json centre = testing::json_of(client.Get("/v1/maps/taveuni/tilejson.json"))["center"];
  EXPECT_LE(std::abs(centre[0].get<double>()), 180.0);
  for (const int x : {0, (1 << 15) - 1}) {
    const int y = static_cast<int>(mercator::mercator_pixel({centre[1], 180.0}, 15).y / 256);
    EXPECT_EQ(client.Get(fmt::format("/v1/maps/taveuni/tiles/15/{}/{}.png", x, y))->status, 200) << x;
  }
}

/// A calibration that weighs nothing but the ground.
std::string calibration_by_ground(const testing::TemporaryFolder& folder, double weight, double sigma_scale = 1.0) {
  const std::filesystem::path path = folder / ("ground-" + std::to_string(weight) + ".json");
  json document{{"format", kCalibrationFormat},
                {"bias", 0.0},
                {"highest", 0.9},
                {"sigma_scale", {{"position", sigma_scale}, {"heading", 1.0}}}};
  for (const CountedFigure& figure : kCountedFigures) {
    document["terms"][figure.name] = {{"weight", figure.name == "ground" ? weight : 0.0}, {"most", 10.0}};
  }
  std::ofstream(path) << document;
  return path.string();
}

TEST(ServiceMaps, IsAsSureAsTheCalibrationItIsGiven) {
  const testing::TemporaryFolder folder;
  const testing::Town town;
  testing::write_map_file(folder / "town.gpkg", town.roads, 2.0);
  const testing::ServiceProcess service(folder.path(),
                                        {"--calibration", calibration_by_ground(folder, 0.0), "--request-time", "600"});
  httplib::Client client = testing::client_of(service);
  const json fix = testing::json_of(client.Post("/v1/maps/town/fix?cell_m=2", town.seen(), "image/png"));
  EXPECT_EQ(fix["status"], "ambiguous") << fix;
  EXPECT_DOUBLE_EQ(fix["probability"].get<double>(), 0.5) << "of a logistic function that weighs nothing";
}

TEST(ServiceMaps, SendsTilesOfLocalizabilityAnewUnderAnotherCalibration) {
  const testing::TemporaryFolder folder;
  testing::write_map_file(folder / "town.gpkg", testing::Town().roads, 2.0);
  const auto tag = [&](double weight, double sigma_scale) {
    const testing::ServiceProcess service(folder.path(),
                                          {"--calibration", calibration_by_ground(folder, weight, sigma_scale)});
    return testing::client_of(service).Get("/v1/maps/town/localizability/tiles/16/0/0.png")->get_header_value("ETag");
  };
  const std::string first = tag(0.2, 1.0);
  EXPECT_EQ(tag(0.2, 1.0), first);
  EXPECT_NE(tag(0.3, 1.0), first);
  EXPECT_NE(tag(0.2, 2.0), first);
}

TEST(ServiceMaps, SendsTilesAnewWhenTheOverviewsOfAMapAreFused) {
  const testing::TemporaryFolder folder;
  MapWriter writer(folder / "city.gpkg", testing::settings_37n());
  const testing::TestSource source{"a", 1, testing::some_blocks(8)};
  for (const TileIndex block : writer.begin_source(source.record(), source.blocks, false)) {
    testing::put_block(writer, "a", block, testing::random_cells(source.seed, block));
  }
  std::stop_source stop;
  const auto stop_after_the_finest = [&](std::int64_t done, std::int64_t) {
    if (done > 0) stop.request_stop();
  };
  EXPECT_THROW(writer.finish_source("a", stop_after_the_finest, stop.get_token()), Interrupted);
  const testing::ServiceProcess service(folder.path());
  httplib::Client client = testing::client_of(service);
  const std::string tile = "/v1/maps/city/tiles/11/1241/791.png";
  const auto before = client.Get(tile);
  ASSERT_EQ(before->status, 204) << "what it shows is not fused yet";

  writer.finish_source("a");
  ASSERT_TRUE(eventually([&] { return testing::json_of(client.Get("/v1/maps/city"))["status"] == "ready"; }));
  const httplib::Headers known{{"If-None-Match", before->get_header_value("ETag")}};
  EXPECT_EQ(client.Get(tile, known)->status, 200);
}

}  // namespace
}  // namespace roadfix
