// Numbers that options refuse, whatever else was given: no file that is named here is there.
#include <gmock/gmock.h>

#include <string>

#include "tests/support/run_program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roadfix {
namespace {

using ::testing::HasSubstr;
using testing::ProgramResult;

class NumberOption : public ::testing::TestWithParam<const char*> {};

TEST_P(NumberOption, TakesNoWordForANumber) {
  const testing::TemporaryFolder folder;
  for (const char* word : {"nan", "-nan", "inf"}) {
    const ProgramResult refused = testing::run_program(folder.path(), std::string(GetParam()) + word);
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.err, HasSubstr("must be a number of at least"));
    EXPECT_THAT(refused.err, HasSubstr(std::string("not ") + word));
  }
}

INSTANTIATE_TEST_SUITE_P(WithALowestAndAHighest, NumberOption,
                         ::testing::Values("detect a.png b.png --cell=", "fix m.gpkg a.png --nadir=0,",
                                           "fix m.gpkg a.png --heading 0 --heading-range=",
                                           "fix m.gpkg a.png --confidence=", "fix m.gpkg a.png --scale-range=",
                                           "match m.gpkg a.png --heading-step=", "bench b.json --confidence=",
                                           "ingest a.geojson --map m.gpkg --width=", "fly m.gpkg --scale-range=",
                                           "fly m.gpkg --wind-sigma=", "frames a.jpg --takeoff-agl=",
                                           "fly m.gpkg --missing="));

}  // namespace
}  // namespace roadfix
