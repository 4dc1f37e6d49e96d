#include "tiles/sources/source_files.hpp"

#include <cpl_vsi.h>
#include <gdal_utils.h>
#include <gmock/gmock.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "core/units/error.hpp"
#include "core/units/file.hpp"
#include "core/units/provenance.hpp"
#include "tests/support/as_another_user.hpp"
#include "tests/support/code_of.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/tiles/sources/test_raster.hpp"
#include "tiles/sources/exported_roads.hpp"
#include "tiles/sources/fingerprint.hpp"
#include "tiles/sources/gdal_session.hpp"

namespace roadfix {
namespace {

using testing::code_of;
using ::testing::ElementsAre;
using testing::write_raster;

constexpr const char* kLine =
    R"({"type":"Feature","properties":{},"geometry":{"type":"LineString","coordinates":[[39,38],[39.1,38]]}})";

class SourceFilesTest : public ::testing::Test {
 protected:
  std::string image(const std::string& name, double value = 1.0) {
    return write_raster(folder / name, {}, [value](int, int, int) { return value; });
  }
  testing::TemporaryFolder folder;
};

TEST_F(SourceFilesTest, RastersAreImageryUnlessCalledRoads) {
  const std::string path = image("city.tif");
  EXPECT_EQ(find_source(path).kind, SourceKind::kImagery);
  EXPECT_EQ(find_source(path, SourceContent::kRoads).kind, SourceKind::kRoadRaster);
  EXPECT_EQ(find_source(path).name, "city");
}

TEST_F(SourceFilesTest, AnotherMapIsRoadsUnlessCalledImagery) {
  const std::string city = write_raster(folder / "city.tif", {.type = GDT_Float32}, [](int, int, int) { return 0.5; });
  const DatasetPtr picture(GDALDataset::Open(city.c_str(), GDAL_OF_RASTER));
  for (const std::string identifier : {"road_probability", "heights"}) {
    const std::string path = (folder / (identifier + ".gpkg")).string();
    const std::string option = "RASTER_IDENTIFIER=" + identifier;
    const std::array<const char*, 2> options{option.c_str(), nullptr};
    const DatasetPtr copy(GetGDALDriverManager()->GetDriverByName("GPKG")->CreateCopy(
        path.c_str(), picture.get(), FALSE, const_cast<char**>(options.data()), nullptr, nullptr));
    const bool map = identifier == "road_probability";
    EXPECT_EQ(find_source(path).kind, map ? SourceKind::kRoadRaster : SourceKind::kImagery);
    EXPECT_EQ(find_source(path, SourceContent::kImagery).kind, SourceKind::kImagery);
    EXPECT_EQ(find_source(path, SourceContent::kRoads).kind, SourceKind::kRoadRaster);
  }
}

TEST_F(SourceFilesTest, WhatGdalMakesOfAMapIsRoadsAndNoMap) {
  const std::string city = write_raster(folder / "city.tif", {.type = GDT_Float32}, [](int, int, int) { return 0.5; });
  const std::string map = (folder / "map.gpkg").string();
  const std::string copy = (folder / "copy.tif").string();
  const std::string vrt = (folder / "all.vrt").string();
  {
    const DatasetPtr picture = open_dataset(city, GDAL_OF_RASTER);
    const std::array<const char*, 2> options{"RASTER_IDENTIFIER=road_probability", nullptr};
    const auto driver = [](const char* name) { return GetGDALDriverManager()->GetDriverByName(name); };
    const DatasetPtr made(driver("GPKG")->CreateCopy(map.c_str(), picture.get(), FALSE,
                                                     const_cast<char**>(options.data()), nullptr, nullptr));
    const DatasetPtr copied(driver("GTiff")->CreateCopy(copy.c_str(), open_dataset(map, GDAL_OF_RASTER).get(), FALSE,
                                                        nullptr, nullptr, nullptr));
    const char* name = map.c_str();
    const DatasetPtr joined(GDALDataset::FromHandle(GDALBuildVRT(vrt.c_str(), 1, nullptr, &name, nullptr, nullptr)));
  }
  for (const std::string& path : {copy, vrt}) {
    const SourceFiles files = find_source(path);
    EXPECT_EQ(files.kind, SourceKind::kRoadRaster) << path;
    EXPECT_FALSE(files.is_map) << path;
  }
}

TEST_F(SourceFilesTest, AMapInAFolderIsLeftOutAndNamed) {
  const std::string map = (folder / "map.gpkg").string();
  {
    const DatasetPtr picture = open_dataset(image("a.tif"), GDAL_OF_RASTER);
    const DatasetPtr made(GetGDALDriverManager()->GetDriverByName("GPKG")->CreateCopy(map.c_str(), picture.get(), FALSE,
                                                                                      nullptr, nullptr, nullptr));
  }
  std::filesystem::remove(folder / "a.tif");
  const auto found = [&] { return find_source(folder.path().string()); };
  EXPECT_THAT(testing::message_of(found), ::testing::HasSubstr("to ingest " + map + ", name it itself"));
  const std::string lines = (folder / "lines.geojson").string();
  std::ofstream(lines) << kLine;
  EXPECT_THAT(found().paths, ElementsAre(lines));
  EXPECT_THAT(found().left_out, ElementsAre(map));
}

TEST_F(SourceFilesTest, ExportsBesidePicturesAreRefusedUnlessAllAreCalledTheSame) {
  const std::string exported = image("export.tif");
  {
    const DatasetPtr file = open_dataset(exported, GDAL_OF_RASTER | GDAL_OF_UPDATE);
    file->SetMetadataItem("TIFFTAG_IMAGEDESCRIPTION", std::string(kExportedRoads).c_str());
  }
  const std::string all = folder.path().string();
  EXPECT_EQ(find_source(all).kind, SourceKind::kRoadRaster);
  const std::string photo = image("photo.tif");
  EXPECT_EQ(code_of([&] { find_source(all); }), "imagery-mixed");
  EXPECT_THAT(testing::message_of([&] { find_source(all); }),
              ::testing::HasSubstr(exported + " holds roads that roadfix wrote, " + photo + " does not"));
  EXPECT_EQ(find_source(all, SourceContent::kImagery).kind, SourceKind::kImagery);
  EXPECT_EQ(find_source(all, SourceContent::kRoads).kind, SourceKind::kRoadRaster);
}

TEST_F(SourceFilesTest, VectorsAreRoadsAndNeverImagery) {
  const std::string path = (folder / "lines.geojson").string();
  std::ofstream(path) << kLine;
  EXPECT_EQ(find_source(path).kind, SourceKind::kRoadVectors);
  EXPECT_EQ(code_of([&] { find_source(path, SourceContent::kImagery); }), "source-not-imagery");
}

TEST_F(SourceFilesTest, AVrtOfLayersIsVectorsAndLeftOutOfAFolder) {
  std::ofstream(folder / "lines.geojson") << kLine;
  const std::string path = (folder / "roads.vrt").string();
  std::ofstream(path) << R"(<OGRVRTDataSource><OGRVRTLayer name="lines"><SrcDataSource relativeToVRT="1">)"
                      << "lines.geojson</SrcDataSource></OGRVRTLayer></OGRVRTDataSource>";
  EXPECT_EQ(find_source(path).kind, SourceKind::kRoadVectors);
  EXPECT_EQ(find_source(path, SourceContent::kRoads).kind, SourceKind::kRoadVectors);
  EXPECT_EQ(code_of([&] { find_source(path, SourceContent::kImagery); }), "source-not-imagery");
  const SourceFiles all = find_source(folder.path().string());
  EXPECT_THAT(all.paths, ElementsAre((folder / "lines.geojson").string()));
  EXPECT_THAT(all.left_out, ElementsAre(path));
  std::ofstream(folder / "broken.vrt") << "<VRTDataset";
  EXPECT_EQ(code_of([&] { find_source((folder / "broken.vrt").string()); }), "source-unreadable");
}

TEST_F(SourceFilesTest, FilesThatOnlyNeedAnotherFormatSayWhich) {
  const auto advice = [&](const char* name, const char* text) {
    std::ofstream(folder / name) << text;
    return testing::message_of([&] { find_source((folder / name).string()); });
  };
  EXPECT_THAT(advice("a.osm.gz", "\x1f\x8b"), ::testing::HasSubstr("unpack it first"));
  EXPECT_THAT(advice("a.osm.BZ2", "BZh9"), ::testing::HasSubstr("unpack it first"));
  EXPECT_THAT(advice("a.json", R"({"version":0.6,"generator":"Overpass API","elements":[]})"),
              ::testing::HasSubstr("[out:xml]"));
  EXPECT_THAT(advice("b.json", R"({"version":1})"), ::testing::HasSubstr("ogrinfo on it tells more"));
  EXPECT_THAT(advice("c.json", ""), ::testing::HasSubstr("it holds nothing"));
  EXPECT_THAT(advice("c.tif", "\n<!DOCTYPE html><html><title>Log in</title></html>"),
              ::testing::HasSubstr("it is a web page"));
  const std::string shapes = folder / "c.shp";
  std::ofstream(shapes) << std::string("\0\0\x27\x0a", 4);
  EXPECT_THAT(testing::message_of([&] { open_dataset(shapes, GDAL_OF_VECTOR); }), ::testing::HasSubstr("put its .shx"));
}

TEST_F(SourceFilesTest, AFolderIsOneSourceOfAllItsImagesInOrder) {
  const std::string b = image("b.tif");
  const std::string a = image("a.tif");
  std::ofstream(folder / "a.tif.aux.xml") << "<PAMDataset/>";
  const SourceFiles files = find_source(folder.path().string() + "/", SourceContent::kRoads);
  EXPECT_THAT(files.paths, ElementsAre(a, b));
  EXPECT_EQ(files.name, folder.path().filename());
  EXPECT_EQ(files.kind, SourceKind::kRoadRaster);
}

TEST_F(SourceFilesTest, AFileGeodatabaseIsAFileThoughItIsAFolder) {
  std::ofstream(folder / "lines.geojson") << kLine;
  const std::string lines = (folder / "lines.geojson").string();
  const std::string geodatabase = (folder / "Roads.gdb").string();
  GDALAllRegister();
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("OpenFileGDB");
  if (driver == nullptr || driver->GetMetadataItem(GDAL_DCAP_CREATE) == nullptr) GTEST_SKIP() << "GDAL writes none";
  {
    const DatasetPtr from = open_dataset(lines, GDAL_OF_VECTOR);
    const DatasetPtr to(driver->Create(geodatabase.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    ASSERT_NE(to, nullptr);
    ASSERT_NE(to->CopyLayer(from->GetLayer(0), "roads"), nullptr);
  }
  std::filesystem::remove(folder / "lines.geojson");
  for (const std::string& way : {geodatabase, geodatabase + "/"}) {
    const SourceFiles files = find_source(way);
    EXPECT_EQ(files.name, "Roads") << way;
    EXPECT_EQ(files.kind, SourceKind::kRoadVectors) << way;
  }
  EXPECT_THAT(find_source(folder.path().string()).paths, ElementsAre(geodatabase));
}

TEST_F(SourceFilesTest, AFolderHasItsNameHoweverItIsReached) {
  image("a.tif");
  std::filesystem::create_directory(folder / "below");
  for (const char* way : {"", "/", "/.", "/./", "/below/..", "/below/../"}) {
    EXPECT_EQ(find_source(folder.path().string() + way).name, folder.path().filename()) << way;
  }
}

TEST_F(SourceFilesTest, VectorsBesideTheImagesOfAFolderAreLeftOutAndNamed) {
  const std::string a = image("a.tif");
  const std::string lines = (folder / "lines.geojson").string();
  std::ofstream(lines) << kLine;
  const SourceFiles files = find_source(folder.path().string());
  EXPECT_THAT(files.paths, ElementsAre(a));
  EXPECT_THAT(files.left_out, ElementsAre(lines));
}

TEST_F(SourceFilesTest, FormatsThatAreNotLookedForInFoldersAreNamed) {
  const std::string notes = (folder / "b.kml").string();
  const std::string grid = (folder / "c.asc").string();
  std::ofstream(folder / "notes.txt") << "hello";
  std::ofstream{notes} << "<kml/>";
  std::ofstream{grid} << "ncols 1";
  EXPECT_THAT(testing::message_of([&] { find_source(folder.path().string()); }),
              ::testing::HasSubstr("name it itself"));
  image("a.tif");
  EXPECT_THAT(find_source(folder.path().string()).left_out, ElementsAre(notes, grid));
}

TEST_F(SourceFilesTest, OtherJsonBesideTheRoadsOfAFolderIsLeftOutAndNamed) {
  const std::string roads = (folder / "roads.json").string();
  const std::string about = (folder / "metadata.json").string();
  std::ofstream{roads} << kLine;
  std::ofstream{about} << R"({"date":"2023","licence":"ODbL"})";
  const SourceFiles files = find_source(folder.path().string());
  EXPECT_THAT(files.paths, ElementsAre(roads));
  EXPECT_THAT(files.left_out, ElementsAre(about));
}

TEST_F(SourceFilesTest, GeoJsonOfALineForEachFeatureIsRoadsInAFolderToo) {
  for (const char* ending : {"geojsonl", "geojsons", "geojsonseq", "ndjson"}) {
    const testing::TemporaryFolder roads;
    const std::string path = (roads / "lines.").string() + ending;
    std::ofstream(path) << kLine << '\n' << kLine << '\n';
    std::ofstream(roads / "log.ndjson") << R"({"level":"info"})" << '\n';
    const SourceFiles files = find_source(roads.path().string());
    EXPECT_THAT(files.paths, ElementsAre(path));
    EXPECT_THAT(files.left_out, ElementsAre((roads / "log.ndjson").string()));
  }
}

TEST_F(SourceFilesTest, AFileOfPixelsAndLinesIsPixelsUnlessALayerIsNamed) {
  const std::string path = (folder / "both.gpkg").string();
  std::ofstream(folder / "lines.geojson") << kLine;
  const std::string lines = (folder / "lines.geojson").string();
  {
    const DatasetPtr picture = open_dataset(image("a.tif"), GDAL_OF_RASTER);
    const DatasetPtr made(GetGDALDriverManager()->GetDriverByName("GPKG")->CreateCopy(
        path.c_str(), picture.get(), FALSE, nullptr, nullptr, nullptr));
    const DatasetPtr from = open_dataset(lines, GDAL_OF_VECTOR);
    ASSERT_NE(made->CopyLayer(from->GetLayer(0), "roads"), nullptr);
  }
  const SourceFiles pixels = find_source(path);
  EXPECT_EQ(pixels.kind, SourceKind::kImagery);
  EXPECT_THAT(pixels.left_out, ElementsAre("layer 'roads' of " + path));
  EXPECT_EQ(find_source(path, SourceContent::kRoads, "roads").kind, SourceKind::kRoadVectors);
  EXPECT_EQ(find_source(image("b.tif"), SourceContent::kRoads, "roads").kind, SourceKind::kRoadRaster);
}

TEST_F(SourceFilesTest, AZipArchiveIsOneSourceOfWhatItHolds) {
  const std::string archive = (folder / "city.shp.zip").string();
  require_gdal();
  for (const char* name : {"town/lines.geojson", "__MACOSX/town/._lines.geojson", "read me.txt"}) {
    VSILFILE* file = VSIFOpenL(("/vsizip/" + archive + "/" + name).c_str(), "wb");
    ASSERT_NE(file, nullptr);
    VSIFWriteL(kLine, 1, std::string_view(kLine).size(), file);
    VSIFCloseL(file);
  }
  const SourceFiles files = find_source(archive);
  EXPECT_THAT(files.paths, ElementsAre("/vsizip/" + archive + "/town/lines.geojson"));
  EXPECT_EQ(files.kind, SourceKind::kRoadVectors);
  EXPECT_EQ(files.name, "city");
  EXPECT_EQ(code_of([&] { open_dataset(files.paths.front(), GDAL_OF_VECTOR); }), "no error");
  std::ofstream(folder / "cut-off.zip") << "PK";
  EXPECT_EQ(code_of([&] { find_source((folder / "cut-off.zip").string()); }), "source-unreadable");
}

TEST_F(SourceFilesTest, WhatIsNoSourceIsRefusedByName) {
  EXPECT_EQ(code_of([&] { find_source((folder / "none.tif").string()); }), "file-not-found");
  EXPECT_THAT(testing::message_of([&] { find_source("roads.gpkg|layername=streets"); }),
              ::testing::HasSubstr("name the layer with --layer"));
  EXPECT_EQ(code_of([&] { find_source(folder.path().string()); }), "source-empty");
  std::ofstream(folder / "letter.txt") << "Dear reader";
  EXPECT_EQ(code_of([&] { find_source((folder / "letter.txt").string()); }), "source-unreadable");
  std::ofstream(folder / "empty.tif") << "";
  EXPECT_EQ(code_of([&] { find_source((folder / "empty.tif").string()); }), "source-unreadable");
}

TEST_F(SourceFilesTest, WhatMayNotBeReadIsNotCalledMissing) {
  const std::string path = image("city.tif");
  const testing::AsAnotherUser other;  // who may not enter the folder
  if (other.may_do_everything()) GTEST_SKIP();
  EXPECT_EQ(code_of([&] { open_dataset(path, GDAL_OF_RASTER); }), "source-unreadable");
}

TEST_F(SourceFilesTest, TheFingerprintChangesWithContentSideFilesAndSettings) {
  const std::string path = image("a.tif", 1.0);
  const std::string before = fingerprint({path}, "x");
  EXPECT_EQ(fingerprint({path}, "x"), before);
  EXPECT_NE(fingerprint({path}, "y"), before);
  std::ofstream(path + ".aux.xml") << "<PAMDataset><Metadata><MDI key=\"a\">b</MDI></Metadata></PAMDataset>";
  EXPECT_NE(fingerprint({path}, "x"), before);
  std::filesystem::remove(path + ".aux.xml");
  EXPECT_EQ(fingerprint({path}, "x"), before);
  image("a.tif", 2.0);
  EXPECT_NE(fingerprint({path}, "x"), before);
}

TEST_F(SourceFilesTest, TheFingerprintOfASmallFileIsThatOfItsCopies) {
  const auto at_another_time = [&](const std::string& path) {
    const std::string before = fingerprint({path}, "x");
    std::filesystem::last_write_time(path, std::filesystem::last_write_time(path) - std::chrono::hours(1));
    return fingerprint({path}, "x") == before;
  };
  EXPECT_TRUE(at_another_time(image("a.tif", 1.0)));
  const std::string large = (folder / "large.mvt").string();
  std::ofstream(large) << "only its begin and end are looked at";
  std::filesystem::resize_file(large, 9 << 20);
  EXPECT_FALSE(at_another_time(large));
}

TEST_F(SourceFilesTest, TheFingerprintStaysWhereAnImageWasOnlyLookedAt) {
  const std::string path = image("a.tif", 1.0);
  const std::string aux = path + ".aux.xml";
  const std::string before = fingerprint({path}, "x");
  // As QGIS leaves it.
  constexpr const char* kLooked =
      R"(<PAMRasterBand band="1"><Histograms><HistItem><HistMin>0</HistMin></HistItem></Histograms>)"
      R"(<Metadata><MDI key="STATISTICS_MEAN">1</MDI></Metadata></PAMRasterBand>)";
  constexpr const char* kTold = R"(<SRS>EPSG:32637</SRS>)";
  std::ofstream(aux) << "<PAMDataset>" << kLooked << "</PAMDataset>";
  EXPECT_EQ(fingerprint({path}, "x"), before);
  std::ofstream(aux) << "<PAMDataset>" << kTold << "</PAMDataset>";
  const std::string told = fingerprint({path}, "x");
  EXPECT_NE(told, before);
  std::ofstream(aux) << "<PAMDataset>" << kTold << kLooked << "</PAMDataset>";
  EXPECT_EQ(fingerprint({path}, "x"), told);
  std::ofstream(aux) << "<PAMDataset>" << kLooked << R"(<PAMRasterBand band="1"><NoDataValue>0</NoDataValue>)"
                     << "</PAMRasterBand></PAMDataset>";
  EXPECT_NE(fingerprint({path}, "x"), before);
}

TEST_F(SourceFilesTest, TheFingerprintChangesWithWhatAnotherProgramWroteIntoAGeoPackageThatItHasOpen) {
  const std::string path = (folder / "roads.gpkg").string();
  require_gdal();
  CPLSetConfigOption("OGR_SQLITE_JOURNAL", "WAL");  // as QGIS
  const DatasetPtr open(
      GetGDALDriverManager()->GetDriverByName("GPKG")->Create(path.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  CPLSetConfigOption("OGR_SQLITE_JOURNAL", nullptr);
  open->CreateLayer("roads");
  open->FlushCache();
  const std::string before = fingerprint({path}, "x");
  const auto file_before = read_file(path);
  open->CreateLayer("more roads");
  open->FlushCache();
  EXPECT_EQ(read_file(path), file_before) << "what is new lies beside it";
  EXPECT_NE(fingerprint({path}, "x"), before);
}

TEST_F(SourceFilesTest, TheFingerprintChangesWithTheImagesOfAVrtOfVrts) {
  const std::string inner = (folder / "inner.vrt").string();
  {
    const DatasetPtr tile(GDALDataset::Open(image("a.tif", 1.0).c_str(), GDAL_OF_RASTER));
    const DatasetPtr made(GetGDALDriverManager()->GetDriverByName("VRT")->CreateCopy(inner.c_str(), tile.get(), FALSE,
                                                                                     nullptr, nullptr, nullptr));
  }
  std::string text = read_file(inner).value();  // GDAL's own copy of a VRT would name the image, not the VRT
  text.replace(text.find("a.tif"), 5, "inner.vrt");
  const std::string outer = (folder / "outer.vrt").string();
  std::ofstream(outer) << text;
  const std::string before = fingerprint({outer}, "x");
  EXPECT_EQ(fingerprint({outer}, "x"), before);
  image("a.tif", 2.0);
  EXPECT_NE(fingerprint({outer}, "x"), before);
}

}  // namespace
}  // namespace roadfix
