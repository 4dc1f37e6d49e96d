#include "cli/bench/frames_csv.hpp"

#include <gmock/gmock.h>

#include "core/units/error.hpp"

namespace roadfix::bench {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(FramesCsv, FindsItsColumnsByName) {
  const auto frames = parse_frames_csv("time,gsd_m,file,lat,lon,heading_deg\r\n12:00,0.4,a/1.jpg,32.1,35.2,90\r\n");
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].file, "a/1.jpg");
  EXPECT_EQ(frames[0].gsd_m, 0.4);
  EXPECT_EQ(frames[0].pose.position.lon_deg, 35.2);
  EXPECT_NEAR(frames[0].pose.heading.degrees(), 90, 1e-12);
}

TEST(FramesCsv, KnowsTheSequenceWhereThereIsOne) {
  const auto frames = parse_frames_csv("file,lat,lon,heading_deg,gsd_m,sequence\na,1,1,0,1,flight\nb,1,1,0,1\n");
  EXPECT_EQ(frames.at(0).sequence, "flight");
  EXPECT_EQ(frames.at(1).sequence, "");
}

TEST(FramesCsv, KnowsTheTimeWhereThereIsOne) {
  const auto frames =
      parse_frames_csv("file,lat,lon,heading_deg,gsd_m,time_s\na,1,1,0,1,12.5\nb,1,1,0,1,\nc,1,1,0,1\n");
  EXPECT_EQ(frames.at(0).time_s, 12.5);
  EXPECT_FALSE(frames.at(1).time_s);
  EXPECT_FALSE(frames.at(2).time_s);
}

TEST(FramesCsv, MayComeFromASpreadsheetWithAByteOrderMarkAndBlanks) {
  const auto frames = parse_frames_csv(
      "\xef\xbb\xbf"
      "file, lat, lon, heading_deg, gsd_m\na.jpg, 32.1, 35.2, 90, 0.4\n");
  EXPECT_EQ(frames.at(0).file, "a.jpg");
  EXPECT_EQ(frames.at(0).pose.position.lat_deg, 32.1);
}

TEST(FramesCsv, ComplaintsNameLineAndColumn) {
  const auto complaint = [](const char* text, const char* part) {
    EXPECT_THAT([&] { parse_frames_csv(text); }, ThrowsMessage<InvalidInput>(HasSubstr(part))) << text;
  };
  complaint("file,lat,lon,gsd_m\n", "heading_deg");
  complaint("file,lat,lon,heading_deg,gsd_m\n", "no frames");
  complaint("file,lat,lon,heading_deg,gsd_m\na,91,0,0,1\n", "lat is '91'");
  complaint("file,lat,lon,heading_deg,gsd_m\na,1,0,0,1\nb,1,nan,0,1\n", "line 3");
  complaint("file,lat,lon,heading_deg,gsd_m\na,1,0\n", "too few");
  complaint("file,lat,lon,heading_deg,gsd_m,time_s\na,1,1,0,1,12:30\n", "time_s is '12:30'");
}

}  // namespace
}  // namespace roadfix::bench
