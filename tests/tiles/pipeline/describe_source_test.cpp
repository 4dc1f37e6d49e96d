#include "tiles/pipeline/describe_source.hpp"

#include <gmock/gmock.h>

namespace roadfix {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

SourceRecord record(const std::string& fingerprint) {
  return {.name = "roads",
          .content = SourceContent::kRoads,
          .fingerprint = fingerprint,
          .provenance = {.registration_sigma_m = 2.5}};
}

SourceRecord credited(const std::string& fingerprint) {
  SourceRecord result = record(fingerprint);
  result.provenance = {.date = "2020", .licence = "CC-BY", .attribution = "X", .registration_sigma_m = 30.0};
  return result;
}

TEST(DescribeSource, ANewOneIsWhatTheUserSaysAndOtherwiseWhatItSaysItself) {
  SourceRecord fresh = record("1");
  fresh.location = "a.tif";
  const Provenance own{.date = "2020", .licence = "CC-BY", .attribution = "X"};
  EXPECT_THAT(
      describe_source(fresh, own, {.licence = "CC0", .registration_sigma_m = 10.0}, {}, false),
      ElementsAre("a.tif says of itself: date '2020', attribution 'X'. That is taken over; --date, --attribution "
                  "would say otherwise"));
  EXPECT_EQ(fresh.provenance.licence, "CC0");
  EXPECT_EQ(fresh.provenance.registration_sigma_m, 10.0);
  EXPECT_EQ(fresh.provenance.attribution, "X");
}

TEST(DescribeSource, RepeatedWithoutOptionsItKeepsWhatWasTold) {
  const std::vector before{credited("1")};
  SourceRecord again = record("1");
  EXPECT_THAT(describe_source(again, {.licence = "of the file"}, {}, before, false), IsEmpty());
  EXPECT_EQ(again, before.front());
}

TEST(DescribeSource, RepeatedWithOptionsItChangesInTheseAlone) {
  const std::vector before{credited("1")};
  SourceRecord again = record("1");
  EXPECT_THAT(
      describe_source(again, {}, {.licence = "CC0", .attribution = "X", .registration_sigma_m = 10.0}, before, false),
      ElementsAre("'roads' now has licence 'CC0' instead of 'CC-BY'",
                  "'roads' now has position within 10 m instead of 30 m (1 sigma)"));
  SourceRecord expected = before.front();
  expected.provenance.licence = "CC0";
  expected.provenance.registration_sigma_m = 10.0;
  EXPECT_EQ(again, expected);
}

TEST(DescribeSource, AnEmptyTextTakesOutWhatWasToldOrWhatTheSourceSaysOfItself) {
  const std::vector before{credited("1")};
  SourceRecord again = record("1");
  EXPECT_THAT(
      describe_source(again, {}, {.date = "", .licence = ""}, before, false),
      ElementsAre("'roads' now has date none instead of '2020'", "'roads' now has licence none instead of 'CC-BY'"));
  EXPECT_EQ(again.provenance.licence, "");
  EXPECT_EQ(again.provenance.attribution, "X");
  SourceRecord fresh = record("2");
  EXPECT_THAT(describe_source(fresh, {.licence = "of the file"}, {.licence = ""}, {}, false), IsEmpty());
  EXPECT_EQ(fresh.provenance.licence, "");
}

TEST(DescribeSource, AnInterruptedOneGoesOnAsItWasBegun) {
  const std::vector before{record("old"), credited("1")};
  SourceRecord again = record("1");
  EXPECT_THAT(describe_source(again, {}, {}, before, false), IsEmpty());
  EXPECT_EQ(again, credited("1"));
}

TEST(DescribeSource, ReplacingDescribesAnewAndSaysWhatIsLost) {
  const std::vector before{credited("1")};
  for (const char* fingerprint : {"1", "2"}) {
    SourceRecord anew = record(fingerprint);
    EXPECT_THAT(
        describe_source(anew, {}, {.date = "2024", .licence = "CC-BY"}, before, true),
        ElementsAre("'roads' now has date '2024' instead of '2020'",
                    AllOf(HasSubstr("--replace describes 'roads' anew: attribution none instead of 'X'"),
                          HasSubstr("with --attribution")),
                    AllOf(HasSubstr("position within 2.5 m instead of 30 m"), HasSubstr("with --registration-sigma"))));
    EXPECT_EQ(anew.provenance.registration_sigma_m, 2.5);
    EXPECT_EQ(anew.provenance.attribution, "");
  }
}

TEST(DescribeSource, OtherContentThatWillBeRefusedIsNotCompared) {
  const std::vector before{credited("1")};
  SourceRecord other = record("2");
  EXPECT_THAT(describe_source(other, {}, {}, before, false), IsEmpty());
}

}  // namespace
}  // namespace roadfix
