// What roadfix ingest says of its sources.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/e2e/ingest_fixture.hpp"

namespace roadfix {
namespace {

using testing::ChildResult;
using ::testing::HasSubstr;
using testing::RasterSpec;
using testing::run_child;
using testing::write_raster;

using IngestReport = testing::IngestCommand;

TEST_F(IngestReport, ANewMapAroundTheEquatorHoldsBothSides) {
  std::ofstream(folder / "quito.geojson")
      << R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{"highway":"primary"},)"
      << R"("geometry":{"type":"LineString","coordinates":[[33.0,-0.004],[33.01,0.012]]}}]})";
  const std::string roads = folder / "quito.geojson";
  const ChildResult both = ingest({roads, "--map", map("both.gpkg")});
  EXPECT_EQ(both.code, 0) << both.err;
  const ChildResult info = run_child(ROADFIX_PROGRAM, {"info", map("both.gpkg")}, folder.path());
  EXPECT_THAT(info.out, ::testing::AllOf(::testing::HasSubstr("EPSG:32736"), ::testing::HasSubstr("latitude -0.00")));
  const ChildResult north = ingest({roads, "--zone", "EPSG:32636", "--map", map("north.gpkg")});
  EXPECT_EQ(north.code, 0) << north.err;
  EXPECT_THAT(north.err, ::testing::AllOf(::testing::HasSubstr("south of the equator is left out"),
                                          ::testing::HasSubstr("--zone EPSG:32736")));
}

TEST_F(IngestReport, ASourceFarFromTheZoneOfTheMapHearsOfBothChoices) {
  const auto road = [&](const std::string& name, double lon_deg) {
    std::ofstream(folder / name) << R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{)"
                                 << R"("highway":"primary"},"geometry":{"type":"LineString","coordinates":[[)"
                                 << lon_deg << ",37.76],[" << lon_deg + 0.01 << ",37.77]]}}]}";
    return std::string(folder / name);
  };
  const std::string home = road("home.geojson", 40.0);
  const std::string far = road("far.geojson", 46.0);
  ASSERT_EQ(ingest({home, "--map", map("a.gpkg")}).code, 0);
  write_raster(folder / "far.tif", {.epsg = 32638, .transform = std::array{588000.0, 1.0, 0.0, 4180000.0, 0.0, -1.0}},
               [](int, int, int) { return 1.0; });
  for (const std::string& source : {far, std::string(folder / "far.tif")}) {
    const ChildResult refused = ingest({source, "--as", "roads", "--map", map("a.gpkg")});
    EXPECT_EQ(refused.code, 1) << source;
    EXPECT_THAT(refused.err, ::testing::AllOf(HasSubstr("[source-in-another-zone]"), HasSubstr("another --map"),
                                              HasSubstr("--zone EPSG:32638"), HasSubstr("0.3 % too long")));
  }
  EXPECT_EQ(ingest({far, "--map", map("own.gpkg")}).code, 0);
  const ChildResult both = ingest({far, home, "--zone", "EPSG:32638", "--map", map("both.gpkg")});
  EXPECT_EQ(both.code, 0) << both.err;
  EXPECT_THAT(both.err, HasSubstr("% too long"));
  const ChildResult near = ingest({road("near.geojson", 44.0), "--map", map("a.gpkg")});
  EXPECT_EQ(near.code, 0);
  EXPECT_THAT(near.err, ::testing::AllOf(HasSubstr(" km from the central meridian of EPSG:32637"),
                                         HasSubstr("0.20 % too long"), HasSubstr("another --map")));
}

TEST_F(IngestReport, ASourceMadeTooLargeByAStrayRoadHearsOfTheExtentOfTheOthers) {
  const auto line = [](double lon, double lat) {
    return fmt::format(R"({{"type":"Feature","geometry":{{"type":"LineString","coordinates":[[{},{}],[{},{}]]}}}})",
                       lon, lat, lon + 0.002, lat + 0.002);
  };
  std::ofstream file(folder / "town.geojson");
  file << R"({"type":"FeatureCollection","features":[)" << line(0.0, 0.0);
  for (int row = 0; row < 10; ++row) {
    for (int col = 0; col < 10; ++col) file << ',' << line(38.2 + 0.001 * col, 37.7 + 0.001 * row);
  }
  file << "]}";
  file.close();
  const std::string source = folder / "town.geojson";
  const ChildResult all = ingest({source, "--map", map("m.gpkg")});
  EXPECT_EQ(all.code, 1);
  EXPECT_THAT(all.err, HasSubstr("100 of its 101 roads"));
  EXPECT_THAT(all.err, HasSubstr("[source-too-large]"));
  const std::size_t start = all.err.find("--extent ") + 9;
  const std::string extent = all.err.substr(start, all.err.find(' ', start) - start);
  EXPECT_EQ(ingest({source, "--map", map("m.gpkg"), "--extent", extent}).code, 0) << extent;
}

TEST_F(IngestReport, AFolderOfImagesFarApartIsToldToBeSplit) {
  std::filesystem::create_directory(folder / "images");
  const auto one = [](int, int, int) { return 1.0; };
  RasterSpec there;
  write_raster(folder / "images/a.tif", there, one);
  there.epsg = 32719;
  write_raster(folder / "images/b.tif", there, one);
  const ChildResult result = ingest({folder / "images", "--detector", "tree", "--map", map("a.gpkg")});
  EXPECT_EQ(result.code, 1);
  EXPECT_THAT(result.err, ::testing::AllOf(HasSubstr("b.tif: its coordinates in EPSG:32719 have no place"),
                                           HasSubstr("folder of their own"), HasSubstr("[source-in-several-zones]")));
}

TEST_F(IngestReport, AnImageThatShowsNothingIsSaidToShowNothing) {
  const std::string image =
      write_raster(folder / "empty.tif", RasterSpec{.nodata = 0.0}, [](int, int, int) { return 0; });
  const ChildResult result = ingest({image, "--as", "roads", "--map", map("a.gpkg")});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.err,
              ::testing::AllOf(HasSubstr("nothing of " + image + " was observed"), HasSubstr("in one colour")));
}

TEST_F(IngestReport, AnImageThatFillsHalfOfNoCellIsSaidToBeTooSmall) {
  for (const double west_m : {500000.0, 500001.5}) {  // within a cell, and where four of them meet
    const std::string image =
        write_raster(folder / "small.tif",
                     {.width = 1, .height = 1, .transform = std::array{west_m, 1.0, 0.0, 4180000.5, 0.0, -1.0}},
                     [](int, int, int) { return 255.0; });
    const ChildResult result = ingest({image, "--as", "roads", "--cell", "2", "--map", map("small.gpkg")});
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_THAT(result.err, ::testing::AllOf(HasSubstr("it fills half of no cell: these are 2 m"),
                                             Not(HasSubstr("all its pixels are"))));
    std::filesystem::remove(map("small.gpkg"));
  }
}

TEST_F(IngestReport, ACopyUnderAnotherNameIsNoticed) {
  const std::string image = picture(600, 0.5);
  const std::string copy = folder / "the copy's.tif";
  std::filesystem::copy_file(image, copy);
  const std::string target = map("my town.gpkg");
  EXPECT_EQ(ingest({image, "--name", "first", "--detector", "tree", "--map", target}).code, 0);
  const ChildResult again = ingest({copy, "--detector", "tree", "--map", target});
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_THAT(again.err, HasSubstr("'the copy's' says exactly what the source 'first' says"));
  EXPECT_THAT(again.err, HasSubstr("take it out: roadfix remove '" + target + R"(' 'the copy'\''s')"));
}

/// Streets of unequal distances, which lie so far to the east.
class StreetSources : public IngestReport {
 protected:
  std::string streets(const std::string& name, double east_deg, int count = 16) {
    std::string features;
    double at = 0.0;
    for (int i = 0; i < count; ++i) {
      at += 0.0008 + 0.0003 * (i * i % 5);
      const double lon = 38.25 + at + east_deg;
      const double lat = 37.75 + at;
      features += fmt::format(
          R"({}{{"type": "Feature", "properties": {{"highway": "residential"}}, "geometry": {{"type": "MultiLineString",
          "coordinates": [[[{}, 37.75], [{}, 37.78]], [[{}, {}], [{}, {}]]]}}}})",
          i == 0 ? "" : ",", lon, lon, 38.25 + east_deg, lat, 38.28 + east_deg, lat);
    }
    std::string path = folder / (name + ".geojson");
    std::ofstream(path) << R"({"type": "FeatureCollection", "features": [)" << features << "]}";
    return path;
  }
};

TEST_F(StreetSources, OfWhichOneLiesBesideTheOthersAreNoticed) {
  EXPECT_EQ(ingest({streets("first", 0.0), "--map", map("m.gpkg")}).code, 0);
  EXPECT_THAT(ingest({streets("again", 0.00003), "--map", map("m.gpkg")}).err, ::testing::Not(HasSubstr("would fit")))
      << "2.6 m";
  const ChildResult beside = ingest({streets("beside", 0.0003), "--map", map("m.gpkg")});
  EXPECT_EQ(beside.code, 0) << beside.err;
  EXPECT_THAT(beside.err, HasSubstr("'beside' would fit the other sources of the map better about"));
  EXPECT_THAT(beside.err, HasSubstr("m to the west"));
}

TEST_F(StreetSources, OfWhichOneIsNearlyACopyOfAnotherAreNoticedAndCountAsOne) {
  EXPECT_EQ(ingest({streets("wrong", 0.0003), "--map", map("m.gpkg")}).code, 0);
  const ChildResult older = ingest({streets("older", 0.0003, 15), "--map", map("m.gpkg")});
  EXPECT_EQ(older.code, 0) << older.err;
  EXPECT_THAT(older.err, HasSubstr("'older' agrees with the source 'wrong' as only a copy does"));
  EXPECT_THAT(older.err, HasSubstr("roadfix remove " + map("m.gpkg") + " older"));
  const ChildResult right = ingest({streets("right", 0.0), "--map", map("m.gpkg")});
  EXPECT_THAT(right.err, ::testing::Not(HasSubstr("copy")));
  for (const char* each : {"'wrong' would fit", "'older' would fit", "'right' would fit"}) {
    EXPECT_THAT(right.err, HasSubstr(each));
  }
}

TEST_F(IngestReport, ADryRunPrintsThePlanAndWritesNothing) {
  const ChildResult result = ingest({picture(600, 0.5), "--detector", "tree", "--dry-run", "--map", map("a.gpkg")});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.out, ::testing::HasSubstr("EPSG:32637"));
  EXPECT_FALSE(std::filesystem::exists(map("a.gpkg")));
}

}  // namespace
}  // namespace roadfix
