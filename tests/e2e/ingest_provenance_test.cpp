// What roadfix ingest keeps of a source beside its cells, over repeated ingests, other maps and exports.
#include <gmock/gmock.h>

#include <filesystem>
#include <string>

#include "tests/e2e/ingest_fixture.hpp"
#include "tests/support/sqlite_file.hpp"

namespace roadfix {
namespace {

using testing::ChildResult;
using ::testing::HasSubstr;
using testing::run_child;

using IngestProvenance = testing::IngestCommand;

TEST_F(IngestProvenance, RepeatedWithoutItsOptionsItKeepsWhatWasToldOfTheSource) {
  const std::string image = picture(600, 0.5);
  const auto info = [&] { return run_child(ROADFIX_PROGRAM, {"info", map("m.gpkg")}, folder.path()).out; };
  const auto told = ::testing::AllOf(HasSubstr("CC-BY"), HasSubstr("Surveyors"), HasSubstr("2020-05"));
  ASSERT_EQ(ingest({image, "--as", "roads", "--map", map("m.gpkg"), "--registration-sigma", "30", "--licence", "CC-BY",
                    "--attribution", "Surveyors", "--date", "2020-05"})
                .code,
            0);
  EXPECT_EQ(ingest({image, "--as", "roads", "--map", map("m.gpkg")}).code, 0);
  EXPECT_THAT(info(), ::testing::AllOf(told, HasSubstr("30 m (1 sigma)")));
  const ChildResult corrected = ingest({image, "--as", "roads", "--map", map("m.gpkg"), "--registration-sigma", "12"});
  EXPECT_THAT(corrected.err, HasSubstr("note: 'city' now has position within 12 m instead of 30 m"));
  EXPECT_THAT(info(), ::testing::AllOf(told, HasSubstr("12 m (1 sigma)")));
  const ChildResult replaced = ingest({image, "--as", "roads", "--map", map("m.gpkg"), "--replace"});
  EXPECT_THAT(replaced.err, HasSubstr("--replace describes 'city' anew: licence none instead of 'CC-BY'"));
  EXPECT_THAT(info(), ::testing::Not(HasSubstr("CC-BY")));
}

TEST_F(IngestProvenance, WhatWasToldOfAMapGoesWithItIntoOtherMapsAndThroughExports) {
  ASSERT_EQ(ingest({picture(600, 0.5), "--as", "roads", "--map", map("m.gpkg"), "--registration-sigma", "30",
                    "--licence", "CC-BY", "--attribution", "© Surveyors", "--date", "2020-05"})
                .code,
            0);
  const auto told = ::testing::AllOf(HasSubstr("CC-BY\n"), HasSubstr("© Surveyors\n"), HasSubstr("2020-05"));
  for (const char* copy : {"m.gpkg", "m.tif", "m.png", "m.mbtiles"}) {
    const std::string source = folder / copy;
    if (source != map("m.gpkg")) {
      ASSERT_EQ(run_child(ROADFIX_PROGRAM, {"export", map("m.gpkg"), source}, folder.path()).code, 0);
    }
    const std::string target = map(std::string("of-") + copy + ".gpkg");
    const ChildResult copied = ingest({source, "--as", "roads", "--map", target});
    EXPECT_EQ(copied.code, 0) << copied.err;
    EXPECT_THAT(copied.err, HasSubstr(source + " says of itself: date '2020-05', licence 'CC-BY', attribution "
                                               "'© Surveyors', position within 30 m (1 sigma)"));
    const std::string info = run_child(ROADFIX_PROGRAM, {"info", target}, folder.path()).out;
    EXPECT_THAT(info, ::testing::AllOf(told, HasSubstr("30 m (1 sigma)"))) << copy;
    EXPECT_EQ(ingest({source, "--as", "roads", "--map", target, "--replace", "--licence", "CC0"}).code, 0);
    EXPECT_THAT(run_child(ROADFIX_PROGRAM, {"info", target}, folder.path()).out, HasSubstr("CC0\n")) << copy;
  }
}

TEST_F(IngestProvenance, AMapOfAnOlderVersionIsRefusedAsASource) {
  ASSERT_EQ(ingest({picture(600, 0.5), "--as", "roads", "--map", map("m.gpkg")}).code, 0);
  testing::open_sqlite(map("m.gpkg")).execute("UPDATE roadfix_meta SET value = '1' WHERE key = 'schema_version'");
  const ChildResult refused = ingest({map("m.gpkg"), "--map", map("n.gpkg")});
  EXPECT_EQ(refused.code, 1);
  EXPECT_THAT(refused.err, HasSubstr("[map-from-older-version]"));
  EXPECT_FALSE(std::filesystem::exists(map("n.gpkg")));
}

TEST_F(IngestProvenance, WhatRoadfixWroteComesBackAsTheRoadsThatItIs) {
  const std::string image = picture(600, 0.5);
  ASSERT_EQ(ingest({image, "--as", "roads", "--map", map("m.gpkg")}).code, 0);
  std::filesystem::create_directory(folder / "exports");
  for (const char* name : {"e.tif", "e.png", "exports/e.png", "e.mbtiles"}) {
    const std::string file = folder / name;
    ASSERT_EQ(run_child(ROADFIX_PROGRAM, {"export", map("m.gpkg"), file}, folder.path()).code, 0);
    const bool in_folder = std::string(name).starts_with("exports");
    const std::string target = map("of-" + std::filesystem::path(file).filename().string() + (in_folder ? "s" : ""));
    const ChildResult back = ingest({in_folder ? (folder / "exports").string() : file, "--cell", "2", "--map", target});
    EXPECT_EQ(back.code, 0) << back.err;
    const std::string info = run_child(ROADFIX_PROGRAM, {"info", target}, folder.path()).out;
    EXPECT_THAT(info, ::testing::AllOf(HasSubstr("(roads)"), HasSubstr("become 0..1"))) << name;
    if (name == std::string("e.mbtiles")) continue;  // on another lattice
    const auto version = [&](const std::string& path) {
      const std::string text = run_child(ROADFIX_PROGRAM, {"info", path}, folder.path()).out;
      const std::size_t at = text.find("version ");
      return text.substr(at, text.find('\n', at) - at);
    };
    EXPECT_EQ(version(target), version(map("m.gpkg"))) << name;
  }
  const std::string detected = folder / "seen.png";
  const ChildResult detect =
      run_child(ROADFIX_PROGRAM, {"detect", image, detected, "--detector", "tree"}, folder.path());
  ASSERT_EQ(detect.code, 0) << detect.err;
  const ChildResult seen = ingest({detected, "--map", map("seen.gpkg"), "--crs", "EPSG:32637"});
  EXPECT_EQ(seen.code, 0) << seen.err;
  EXPECT_THAT(run_child(ROADFIX_PROGRAM, {"info", map("seen.gpkg")}, folder.path()).out,
              ::testing::AllOf(HasSubstr("(roads)"), HasSubstr("values 0..254 become 0..1")));
}

}  // namespace
}  // namespace roadfix
