#include "cli/evaluation/frames_csv.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <variant>

#include "cli/evaluation/frame_files.hpp"
#include "core/units/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roadfix::evaluation {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(FramesCsv, FindsItsColumnsByName) {
  const auto frames = parse_frames_csv("time,gsd_m,file,lat,lon,heading_deg\r\n12:00,0.4,a/1.jpg,32.1,35.2,90\r\n");
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].file, "a/1.jpg");
  EXPECT_EQ(std::get<StraightDown>(frames[0].view).gsd_m, 0.4);
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

TEST(FramesCsv, TakesNoCellBeyondTheHeaderForAColumnThatIsNotThere) {
  const auto frames = parse_frames_csv("file,lat,lon,heading_deg,gsd_m\na,1,1,0,1,,\n");
  EXPECT_EQ(frames.at(0).sequence, "");
  EXPECT_FALSE(frames.at(0).time_s);
  EXPECT_TRUE(std::holds_alternative<StraightDown>(frames.at(0).view));
}

TEST(FramesCsv, OfAnotherSpreadsheetThanCanBeReadIsRefusedForWhatItIs) {
  const auto told = [](const char* text, const char* what) {
    EXPECT_THAT([=] { parse_frames_csv(text); }, ThrowsMessage<InvalidInput>(HasSubstr(what))) << text;
  };
  told("file;lat;lon;heading_deg;gsd_m\na;1;1;0;1\n", "columns are separated by commas");
  told("file\tlat\tlon\theading_deg\tgsd_m\na\t1\t1\t0\t1\n", "columns are separated by commas");
  told("file,lat,lon,heading_deg,gsd_m\n\"a, b\",1,1,0,1\n", "line 2: it has quotes");
  told("\"file\",\"lat\",\"lon\",\"heading_deg\",\"gsd_m\"\n", "line 1: it has quotes");
  told("file,lat,lon,heading_deg,gsd_m\na,1,5,1,5,0,0,5\n", "it has 8 fields, and the header 5");
}

TEST(FramesCsv, IsNamedWhereItsFileCannotBeRead) {
  const testing::TemporaryFolder folder;
  std::ofstream(folder / "flight.csv") << "file,lat,lon,heading_deg,gsd_m\na,north,1,0,1\n";
  EXPECT_THAT([&] { read_frames_csv(folder / "flight.csv"); },
              ThrowsMessage<InvalidInput>(AllOf(HasSubstr("flight.csv: "), HasSubstr("line 2: lat is 'north'"))));
}

TEST(FramesCsv, PassesOverTheEmptyRowsOfSpreadsheets) {
  EXPECT_EQ(parse_frames_csv("file,lat,lon,heading_deg,gsd_m\r\n,,,,\r\na,1,1,0,1\r\n , ,,,\r\n").size(), 1u);
}

TEST(FramesCsv, MayComeFromASpreadsheetWithAByteOrderMarkAndBlanks) {
  const auto frames = parse_frames_csv(
      "\xef\xbb\xbf"
      "file, lat, lon, heading_deg, gsd_m\na.jpg, 32.1, 35.2, 90, 0.4\n");
  EXPECT_EQ(frames.at(0).file, "a.jpg");
  EXPECT_EQ(frames.at(0).pose.position.lat_deg, 32.1);
}

TEST(FramesCsv, DescribesTheCameraOfAFrame) {
  const auto frames = parse_frames_csv(
      "file,lat,lon,heading_deg,gsd_m,agl_m,fov_deg,focal_px,roll_deg,pitch_deg,principal_px,lens,distortion,"
      "attitude_sigma_deg\n"
      "a,1,1,0,0.5\n"
      "b,1,1,0,,120,84,,1.5,-3,,,,0.2\n"
      "c,1,1,0,,300,,1000,,,811 588.5,fisheye,-0.28  0.08 1e-3 0\n");
  EXPECT_TRUE(std::holds_alternative<StraightDown>(frames.at(0).view));
  const FrameCamera simple = std::get<FrameCamera>(frames.at(1).view);
  EXPECT_EQ(simple.agl_m, 120.0);
  EXPECT_EQ(simple.horizontal_fov, Angle::degrees(84));
  EXPECT_EQ(simple.roll, Angle::degrees(1.5));
  EXPECT_EQ(simple.pitch, Angle::degrees(-3));
  EXPECT_EQ(simple.attitude_sigma, Angle::degrees(0.2));
  EXPECT_FALSE(simple.focal_px || simple.principal_px);
  const FrameCamera calibrated = std::get<FrameCamera>(frames.at(2).view);
  EXPECT_EQ(calibrated.focal_px, 1000.0);
  EXPECT_EQ(calibrated.principal_px, cv::Point2d(811, 588.5));
  EXPECT_EQ(calibrated.lens, LensModel::kFisheye);
  EXPECT_EQ(calibrated.distortion, (std::vector{-0.28, 0.08, 1e-3, 0.0}));
  EXPECT_FALSE(calibrated.roll || calibrated.pitch || calibrated.attitude_sigma);
}

TEST(FramesCsv, TellsTheHeightAboveTheSeaOfACamera) {
  const char* text = "file,lat,lon,heading_deg,agl_m,alt_m,fov_deg\na,1,1,0,,-12.5,84\nb,1,1,0,300,,84\n";
  const auto frames = parse_frames_csv(text);
  EXPECT_EQ(frames.at(0).alt_m, -12.5);
  EXPECT_EQ(std::get<FrameCamera>(frames[0].view).horizontal_fov, Angle::degrees(84));
  EXPECT_FALSE(frames.at(1).alt_m);
  EXPECT_EQ(std::get<FrameCamera>(frames[1].view).agl_m, 300.0);
}

TEST(FramesCsv, ComplaintsNameLineAndColumn) {
  const auto complaint = [](const char* text, const char* part) {
    EXPECT_THAT([&] { parse_frames_csv(text); }, ThrowsMessage<InvalidInput>(HasSubstr(part))) << text;
  };
  complaint("file,lat,lon,gsd_m\n", "heading_deg");
  complaint("file,lat,lon,heading_deg,gsd_m\n", "no frames");
  complaint("file,lat,lon,heading_deg,gsd_m,lat\na,1,1,0,1,2\n", "line 1: the column 'lat' is there twice");
  complaint("file,lat,lon,heading_deg,gsd_m\na,91,0,0,1\n", "lat is '91'");
  complaint("file,lat,lon,heading_deg,gsd_m\na,1,0,0,1\nb,1,nan,0,1\n", "line 3");
  complaint("file,lat,lon,heading_deg,gsd_m\na,1,0\n", "heading_deg is ''");
  complaint("file,lat,lon,heading_deg,gsd_m,time_s\na,1,1,0,1,12:30\n", "time_s is '12:30'");
  complaint("file,lat,lon,heading_deg\na,1,1,0\n", "neither");
  const auto of_the_camera = [&](const std::string& row, const char* part) {
    const std::string header =
        "file,lat,lon,heading_deg,gsd_m,agl_m,fov_deg,focal_px,principal_px,lens,distortion,alt_m,"
        "attitude_sigma_deg\n";
    complaint((header + "a,1,1,0," + row + "\n").c_str(), part);
  };
  of_the_camera(",,84", "give gsd_m");
  of_the_camera("0.5,120,84", "give gsd_m");
  of_the_camera(",120", "either fov_deg or focal_px");
  of_the_camera(",120,84,1000", "either fov_deg or focal_px");
  of_the_camera(",120m,84", "agl_m is '120m'");
  of_the_camera("0.5,,,,,,,500", "give gsd_m");
  of_the_camera(",120,84,,,,,500", "either agl_m or alt_m");
  of_the_camera(",,,,,,,500", "alt_m need either fov_deg or focal_px");
  of_the_camera(",120,,1000,800", "principal_px must be two numbers");
  of_the_camera(",120,,1000,,pinhole", "lens is 'pinhole'");
  of_the_camera(",120,,1000,,,0.1 x", "distortion is 'x'");
  of_the_camera(",120,84,,,,,,25", "attitude_sigma_deg is '25'; it must be a number within 0 to 20");
}

}  // namespace
}  // namespace roadfix::evaluation
