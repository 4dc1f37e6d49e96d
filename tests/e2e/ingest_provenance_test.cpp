// What roadfix ingest keeps of a source beside its cells, over repeated ingests, other maps and exports.
#include <gmock/gmock.h>

#include <filesystem>
#include <string>

#include "tests/e2e/ingest_fixture.hpp"

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

}  // namespace
}  // namespace roadfix
