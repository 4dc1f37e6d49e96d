// roadfix frames as a script meets it: pictures with the XMP of a drone become a table that bench reads.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <variant>
#include <vector>

#include "cli/evaluation/frames_csv.hpp"
#include "tests/support/drone_jpeg.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roadfix {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::ProgramResult;
using testing::run_program;
using testing::text_of;

class FramesCommand : public ::testing::Test {
 protected:
  FramesCommand() { std::filesystem::create_directory(folder / "flight 1"); }

  void picture(const std::string& name, const std::string& tags, std::uint8_t film_mm = 0) const {
    auto jpeg = testing::drone_jpeg(ground(), tags);
    if (film_mm > 0) testing::add_film_focal_length(jpeg, film_mm);
    write(name, jpeg);
  }
  static cv::Mat ground() {
    cv::Mat ground(90, 120, CV_8UC1);
    cv::theRNG().state = 1;
    cv::randu(ground, 0, 256);
    return ground;
  }
  void write(const std::string& name, const std::vector<std::uint8_t>& jpeg) const {
    std::ofstream file(folder / "flight 1" / name, std::ios::binary);
    file.write(reinterpret_cast<const char*>(jpeg.data()), static_cast<std::streamsize>(jpeg.size()));
  }
  static std::string tags(double height_m) {
    return fmt::format(
        "drone-dji:GpsLatitude=\"+37.76\" drone-dji:GpsLongitude=\"+38.26\" drone-dji:RelativeAltitude=\"{:+.2f}\" "
        "drone-dji:GimbalYawDegree=\"-90.0\" drone-dji:GimbalPitchDegree=\"-87.0\" drone-dji:GimbalRollDegree=\"+0.0\" "
        "drone-dji:CalibratedFocalLength=\"100\"",
        height_m);
  }
  ProgramResult frames(const std::string& arguments) const { return run_program(folder.path(), "frames " + arguments); }

  testing::TemporaryFolder folder;
};

TEST_F(FramesCommand, MakesATableThatBenchReads) {
  picture("0002.JPG", tags(120.0));
  picture("0001.jpg", tags(118.0));
  const ProgramResult result = frames(fmt::format("'{}' --csv '{}' --takeoff-agl 10", (folder / "flight 1").string(),
                                                  (folder / "frames.csv").string()));
  ASSERT_EQ(result.code, 0) << result.err;
  const auto table = evaluation::parse_frames_csv(text_of(folder / "frames.csv"));
  ASSERT_EQ(table.size(), 2U);
  EXPECT_EQ(table[0].file, "flight 1/0001.jpg");
  EXPECT_EQ(table[0].sequence, "flight 1");
  EXPECT_DOUBLE_EQ(table[0].pose.position.lat_deg, 37.76);
  EXPECT_DOUBLE_EQ(table[0].pose.heading.degrees(), 270.0);
  EXPECT_DOUBLE_EQ(std::get<FrameCamera>(table[0].view).agl_m, 128.0);
  EXPECT_DOUBLE_EQ(std::get<FrameCamera>(table[1].view).agl_m, 130.0);
  EXPECT_DOUBLE_EQ(std::get<FrameCamera>(table[0].view).focal_px.value(), 100.0);
  EXPECT_DOUBLE_EQ(std::get<FrameCamera>(table[0].view).pitch.value().degrees(), 3.0);
}

TEST_F(FramesCommand, TellsSeveralPicturesOfASecondApart) {
  for (const char* subseconds : {"75", "25"}) {
    auto jpeg = testing::drone_jpeg(ground(), tags(100.0));
    testing::add_time(jpeg, "2023:02:09 11:05:10", subseconds);
    write(fmt::format("{}.jpg", subseconds), jpeg);
  }
  const ProgramResult result = frames(fmt::format("'{}'", (folder / "flight 1").string()));
  ASSERT_EQ(result.code, 0) << result.err;
  const auto table = evaluation::parse_frames_csv(result.out);
  ASSERT_EQ(table.size(), 2U);
  EXPECT_EQ(table[0].time_s, 1675940710.25);
  EXPECT_EQ(table[1].time_s, 1675940710.75);
}

TEST_F(FramesCommand, TellsHeightsAboveTheSeaWhereThatOfTheTakeOffIsTold) {
  picture("0001.jpg", tags(118.0));
  picture("0002.jpg", tags(-20.0));
  std::string above_ground = tags(0.0);
  picture("0003.jpg",
          above_ground.replace(above_ground.find("drone-dji:Rel"), 34, "Camera:AboveGroundAltitude=\"90\""));
  const ProgramResult result = frames(fmt::format("'{}' --csv '{}' --takeoff-alt 655.5", (folder / "flight 1").string(),
                                                  (folder / "frames.csv").string()));
  ASSERT_EQ(result.code, 0) << result.err;
  const auto table = evaluation::parse_frames_csv(text_of(folder / "frames.csv"));
  ASSERT_EQ(table.size(), 2U) << result.err;
  EXPECT_EQ(table[0].alt_m, 773.5);
  EXPECT_EQ(table[1].alt_m, 635.5) << "below the take-off there may be a valley";
  EXPECT_THAT(result.err, AllOf(HasSubstr("0003.jpg is left out: its file does not tell its height above the take-off"),
                                Not(HasSubstr("--takeoff-agl"))));
  EXPECT_EQ(frames("x.jpg --takeoff-alt 655 --takeoff-agl 10").code, 2);
}

TEST_F(FramesCommand, LeavesOutWhatDoesNotTellEnoughAndSaysWhatIsMissing) {
  picture("good.jpg", tags(120.0));
  picture("bare.jpg", "");
  picture("ground.jpg", tags(-1.0));
  picture("space.jpg", tags(1e6));
  std::string ahead = tags(120.0);
  picture("ahead.jpg", ahead.replace(ahead.find("-87.0"), 5, "-5.0"));
  picture("a,b.jpg", tags(120.0));
  picture("a\"b.jpg", tags(120.0));
  const ProgramResult result = frames("'" + (folder / "flight 1").string() + "'");
  EXPECT_EQ(result.code, 0);
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("good.jpg,"), Not(HasSubstr("bare")), Not(HasSubstr("ground")), Not(HasSubstr("ahead"))));
  EXPECT_THAT(result.err, AllOf(HasSubstr("bare.jpg is left out: its file does not tell its place"),
                                HasSubstr("ground.jpg is left out: it was taken -1.0 m above ground"),
                                HasSubstr("space.jpg is left out: its file tells a height of 1e+06 m"),
                                HasSubstr("ahead.jpg is left out: its camera looked at the horizon or the sky"),
                                HasSubstr("a,b.jpg is left out: no table of frames can hold the commas"),
                                HasSubstr("a\"b.jpg is left out: no table of frames"), HasSubstr("1 of 7 pictures"),
                                HasSubstr("--takeoff-agl")));
}

TEST_F(FramesCommand, LeavesOutDamagedAndMissingFilesAndTellsByItsExitCode) {
  picture("good.jpg", tags(120.0));
  picture("bare.jpg", "");
  std::ofstream(folder / "flight 1" / "empty.jpg").flush();
  std::ofstream(folder / "flight 1" / "text.JPG") << "no picture";
  const std::string place = "'" + (folder / "flight 1").string() + "'";
  const ProgramResult result = frames("nothere.jpg " + place);
  EXPECT_EQ(result.code, 1);
  EXPECT_THAT(result.out, AllOf(HasSubstr("good.jpg,"), Not(HasSubstr("empty")), Not(HasSubstr("text"))));
  EXPECT_THAT(result.err, AllOf(HasSubstr("empty.jpg is left out: the file is empty"),
                                HasSubstr("text.JPG is left out: cannot be opened ("), HasSubstr("1 of 5 pictures\n"),
                                HasSubstr("nothere.jpg is left out: no such file"), HasSubstr("[file-not-found]"),
                                HasSubstr("4 of 5 pictures were left out"), HasSubstr("[pictures-left-out]")));
}

TEST_F(FramesCommand, WritesNoTableThatItsNamesBreak) {
  picture("0001.jpg", tags(118.0));
  const auto flight = folder / "north, a" / "flight, b";
  std::filesystem::create_directory(folder / "north, a");
  std::filesystem::rename(folder / "flight 1", flight);
  const auto table = [&](const std::filesystem::path& csv, const std::string& more) {
    return frames(fmt::format("'{}' --csv '{}' {}", flight.string(), csv.string(), more));
  };
  EXPECT_THAT(table(folder / "north, a" / "frames.csv", "--sequence b").err,
              HasSubstr("of 'flight, b/0001.jpg': rename it, or write the table into its folder"));
  EXPECT_THAT(table(flight / "frames.csv", "").err, HasSubstr("'flight, b': name the flight with --sequence"));
  EXPECT_EQ(table(flight / "frames.csv", "--sequence 'a, b'").code, 2);
  ASSERT_EQ(table(flight / "frames.csv", "--sequence b").code, 0);
  EXPECT_EQ(evaluation::parse_frames_csv(text_of(flight / "frames.csv")).at(0).file, "0001.jpg");
}

TEST_F(FramesCommand, LeavesOutWhatWasMadeSmallerByAProgramThatDidNotSaySo) {
  picture("whole.jpg", tags(120.0), 29);    // 100 pixels
  picture("smaller.jpg", tags(120.0), 14);  // 100 pixels of the camera's 240 x 180, of which 120 x 90 are left
  const std::string place = "'" + (folder / "flight 1").string() + "'";
  const ProgramResult result = frames(place);
  EXPECT_EQ(result.code, 0);
  EXPECT_THAT(result.out, AllOf(HasSubstr("whole.jpg,"), Not(HasSubstr("smaller"))));
  EXPECT_THAT(result.err, HasSubstr("smaller.jpg is left out: its file tells two focal lengths: 100 pixels"));
  const std::string smaller = "'" + (folder / "flight 1" / "smaller.jpg").string() + "'";
  EXPECT_THAT(run_program(folder.path(), "detect --exif " + smaller + " roads.png").err,
              AllOf(HasSubstr("[camera-contradictory]"), HasSubstr("--focal-px and --agl")));
}

/// What detect says of a frame, but for its time and what angles lose by being turned to and fro.
nlohmann::json detected(const std::filesystem::path& folder, const std::string& arguments) {
  const std::string target = "'" + (folder / "roads.png").string() + "'";
  const ProgramResult result = run_program(folder, fmt::format("detect --json {} {}", arguments, target));
  EXPECT_EQ(result.code, 0) << result.err;
  auto answer = nlohmann::json::parse(result.out);
  answer.erase("time_ms");
  for (const char* name : {"nadir_col", "nadir_row"}) {
    answer.at(name) = std::round(1e6 * answer.at(name).get<double>());
  }
  return answer;
}

TEST_F(FramesCommand, TellsOtherCommandsTheCameraOfAFrame) {
  picture("0001.jpg", tags(118.0));
  picture("bare.jpg", "");
  const std::string file = "'" + (folder / "flight 1" / "0001.jpg").string() + "'";
  EXPECT_EQ(detected(folder.path(), file + " --exif"),
            detected(folder.path(), file + " --focal-px 100 --agl 118 --roll 0 --pitch 3"));
  EXPECT_EQ(detected(folder.path(), file + " --exif --agl 90 --pitch -8"),
            detected(folder.path(), file + " --focal-px 100 --agl 90 --roll 0 --pitch -8"));
  const std::string bare = "'" + (folder / "flight 1" / "bare.jpg").string() + "'";
  EXPECT_THAT(run_program(folder.path(), "detect --exif " + bare + " roads.png").err,
              HasSubstr("[camera-not-in-file]"));
}

TEST_F(FramesCommand, TellsOtherCommandsHowWellTheAttitudeOfAPhotoIsKnown) {
  picture("0001.jpg", tags(118.0));
  const std::string file = "'" + (folder / "flight 1" / "0001.jpg").string() + "'";
  const nlohmann::json known = detected(folder.path(), file + " --exif --attitude-sigma 3");
  const double degree_m = detected(folder.path(), file + " --exif")["nadir_sigma_m"];
  EXPECT_NEAR(known["nadir_sigma_m"].get<double>(), 3.0 * degree_m, 0.05 * degree_m);
  EXPECT_EQ(known, detected(folder.path(), file + " --focal-px 100 --agl 118 --roll 0 --pitch 3 --attitude-sigma 3"));
}

TEST_F(FramesCommand, AsksWhereACameraLookedOfWhichTheFileDoesNotTellIt) {
  picture("0001.jpg", "drone-dji:RelativeAltitude=\"+118\" drone-dji:CalibratedFocalLength=\"100\"");
  const std::string file = "'" + (folder / "flight 1" / "0001.jpg").string() + "'";
  for (const char* told : {"", " --pitch 3", " --roll 0"}) {
    EXPECT_THAT(run_program(folder.path(), "detect --exif " + file + told + " roads.png").err,
                AllOf(HasSubstr("[camera-not-in-file]"), HasSubstr("--roll and --pitch")))
        << told;
  }
  EXPECT_EQ(detected(folder.path(), file + " --exif --roll 0 --pitch 3"),
            detected(folder.path(), file + " --focal-px 100 --agl 118 --roll 0 --pitch 3"));
  for (const char* wrong : {"--gsd 1 --roll 0 ", "--gsd 1 --attitude-sigma 2 ", "--exif --attitude-sigma 0 ",
                            "--exif --attitude-sigma 20.1 "}) {
    EXPECT_EQ(run_program(folder.path(), std::string("detect ") + wrong + file + " roads.png").code, 2) << wrong;
  }
}

TEST_F(FramesCommand, RefusesWhereThereIsNothingToRead) {
  const std::string place = "'" + (folder / "flight 1").string() + "'";
  EXPECT_THAT(frames(place).err, HasSubstr("[no-pictures]"));
  picture("bare.jpg", "");
  EXPECT_THAT(frames(place).err, HasSubstr("[no-drone-pictures]"));
  EXPECT_THAT(frames("missing.jpg").err, HasSubstr("[file-not-found]"));
  EXPECT_THAT(frames("missing.jpg missing2.jpg").err, HasSubstr("[pictures-left-out]"));
  const std::string file = "'" + (folder / "flight 1" / "bare.jpg").string() + "'";
  EXPECT_THAT(frames(file + " --csv " + file).err, HasSubstr("[target-is-source]"));
}

}  // namespace
}  // namespace roadfix
