// roadfix detect as a script meets it.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "tests/support/run_program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roadfix {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::ProgramResult;
using testing::run_program;
using testing::text_of;

/// A bright street across grass, 200 x 120 pixels.
class DetectCommand : public ::testing::Test {
 protected:
  DetectCommand() {
    cv::Mat picture(120, 200, CV_8UC3);
    cv::randu(picture, 40, 120);
    cv::line(picture, {0, 60}, {200, 60}, cv::Scalar::all(180), 14);
    cv::imwrite(folder / "frame.png", picture);
  }

  ProgramResult detect(const std::string& arguments) const {
    return run_program(folder.path(), "detect --detector tree " + (folder / "frame.png").string() + " " +
                                          (folder / "roads.png").string() + " " + arguments);
  }

  testing::TemporaryFolder folder;
};

TEST_F(DetectCommand, SaysWhyItCannotWrite) {
  const std::string frame = "detect --detector tree " + (folder / "frame.png").string() + " --gsd 1 ";
  const ProgramResult full = run_program(folder.path(), frame + "/dev/full");
  EXPECT_EQ(full.code, 1);
  EXPECT_THAT(full.err, HasSubstr("/dev/full cannot be written (No space left on device): check"));
  EXPECT_THAT(run_program(folder.path(), frame + (folder / "frame.png").string()).err, HasSubstr("target-is-source"));
  EXPECT_THAT(run_program(folder.path(), frame + "/no/such/folder/roads.png").err,
              HasSubstr("(No such file or directory): check"));
}

TEST_F(DetectCommand, NamesThePictureWhateverIsWrongWithIt) {
  const std::string frame = (folder / "frame.png").string();
  EXPECT_THAT(detect("--gsd 9").err, AllOf(HasSubstr(frame + ": "), HasSubstr("[frame-too-coarse]")));
  std::fstream(frame, std::ios::in | std::ios::out | std::ios::binary).seekp(16).put(0x7f);  // 2 billion columns
  EXPECT_THAT(detect("--gsd 1").err, AllOf(HasSubstr(frame + ": "), HasSubstr("[image-too-large]")));
}

TEST_F(DetectCommand, WritesNoPngUnderTheNameOfAnotherFormat) {
  const std::string frame = "detect --detector tree " + (folder / "frame.png").string() + " --gsd 1 ";
  for (const char* name : {"roads.jpg", "roads.TIF", "roads.png.bak"}) {
    const ProgramResult result = run_program(folder.path(), frame + (folder / name).string());
    EXPECT_EQ(result.code, 1) << name;
    EXPECT_THAT(result.err, AllOf(HasSubstr("[feature-map-not-png]"), HasSubstr("end in .png")));
    EXPECT_FALSE(std::filesystem::exists(folder / name));
  }
  for (const char* name : {"roads.PNG", "roads"}) {
    EXPECT_EQ(run_program(folder.path(), frame + (folder / name).string()).code, 0) << name;
  }
}

TEST_F(DetectCommand, OverwritesNoPictureButAFeatureMap) {
  const std::string before = text_of(folder / "frame.png");
  std::filesystem::create_directory(folder / "photos");
  for (const char* other : {"other.png", "other", "photos/frame.png"}) {
    std::filesystem::copy_file(folder / "frame.png", folder / other);
  }
  const std::string frame = "detect --detector tree --gsd 1 " + (folder / "frame.png").string() + " ";
  for (const char* other : {"other.png", "other", "photos"}) {
    const ProgramResult result = run_program(folder.path(), frame + (folder / other).string());
    EXPECT_EQ(result.code, 1) << other;
    EXPECT_THAT(result.err, AllOf(HasSubstr("[target-is-picture]"), HasSubstr("the last name is what gets written")));
  }
  for (const char* other : {"other.png", "other", "photos/frame.png"}) {
    EXPECT_EQ(text_of(folder / other), before) << other;
  }
  for (int times = 0; times < 2; ++times) EXPECT_EQ(detect("--gsd 1").code, 0);
}

TEST_F(DetectCommand, WritesSeveralPicturesIntoAFolderAlone) {
  std::string names;
  for (const char* name : {"first.png", "second.png", "third.png"}) {
    std::filesystem::copy_file(folder / "frame.png", folder / name);
    names += " " + (folder / name).string();
  }
  const ProgramResult result = run_program(folder.path(), "detect --detector tree --gsd 1" + names);
  EXPECT_EQ(result.code, 1);
  EXPECT_THAT(result.err, AllOf(HasSubstr("third.png is no folder"), HasSubstr("[target-not-folder]")));
}

TEST_F(DetectCommand, SaysThatOneDetectorForAllMapsDoesNotCareWhatTheyShow) {
  EXPECT_THAT(detect("--gsd 1 --compare-with roads").err, HasSubstr("[option-without-effect]"));
  EXPECT_EQ(detect("--gsd 1").code, 0);
  const ProgramResult number = detect("--gsd 1 --compare-with 1");
  EXPECT_EQ(number.code, 2);
  EXPECT_THAT(number.err, HasSubstr("1 not in {imagery,roads}"));
}

TEST_F(DetectCommand, WritesNothingButThePngToStandardOutput) {
  const std::string frame = "detect --detector tree " + (folder / "frame.png").string() + " --gsd 0.5 ";
  const ProgramResult result = run_program(folder.path(), frame + "/dev/stdout");
  EXPECT_EQ(result.code, 0);
  EXPECT_THAT(result.err, HasSubstr("50 x 30 cells"));
  EXPECT_EQ(run_program(folder.path(), frame + (folder / "roads.png").string()).code, 0);
  EXPECT_EQ(result.out, text_of(folder / "roads.png"));
  EXPECT_THAT(run_program(folder.path(), frame + "-").err, HasSubstr("[target-is-dash]"));
}

TEST_F(DetectCommand, TurnsAFrameOfKnownScaleIntoCells) {
  const ProgramResult result = detect("--gsd 0.5 --json");
  ASSERT_EQ(result.code, 0) << result.err;
  const auto answer = nlohmann::json::parse(result.out);
  EXPECT_EQ(answer["cols"], 50);
  EXPECT_EQ(answer["rows"], 30);
  EXPECT_EQ(cv::imread(folder / "roads.png", cv::IMREAD_UNCHANGED).channels(), 4);
  EXPECT_FALSE(std::filesystem::exists(folder / "roads.pgw"));
}

TEST_F(DetectCommand, RectifiesWhatACameraSaw) {
  // Straight down from 100 m with 90 degrees across: 200 m wide, 120 m high.
  const auto level = nlohmann::json::parse(detect("--fov 90 --agl 100 --json").out);
  EXPECT_EQ(level["cols"], 100);
  EXPECT_EQ(level["rows"], 60);
  const auto nose_up = nlohmann::json::parse(detect("--fov 90 --agl 100 --pitch 30 --json").out);
  EXPECT_GT(nose_up["nadir_row"], nose_up["rows"].get<double>() / 2.0) << "the ground seen lies ahead of the UAV";
}

TEST_F(DetectCommand, TakesTheCalibrationOfACamera) {
  const std::string by_focal = "--focal-px 100 --agl 100 --json ";
  EXPECT_EQ(nlohmann::json::parse(detect(by_focal).out)["cols"], 100);
  const auto barrel = nlohmann::json::parse(detect(by_focal + "--distortion -0.1,0,0,0 --principal-px 105,60").out);
  EXPECT_GT(barrel["cols"], 105) << "its edges see farther";
  const auto fisheye = nlohmann::json::parse(detect(by_focal + "--fisheye --distortion 0,0,0,0").out);
  const double corner = std::hypot(1.0, 0.6);  // radians from the optical axis, one across
  EXPECT_NEAR(fisheye["cols"].get<double>(), 100.0 * std::tan(corner) / corner, 2.0);
  EXPECT_THAT(detect(by_focal + "--distortion 0,0,0,0,0,0").err, HasSubstr("[frame-camera]"));
  EXPECT_THAT(detect(by_focal + "--principal-px 210,60").err, HasSubstr("for frames of this size"));
}

TEST_F(DetectCommand, KeepsThePlaceOfAGeoreferencedImage) {
  std::ofstream(folder / "frame.pgw") << "0.5\n0\n0\n-0.5\n434000.25\n4179999.75\n";
  std::ofstream(folder / "frame.png.aux.xml") << "<PAMDataset><SRS>EPSG:32637</SRS></PAMDataset>";
  const ProgramResult result = detect("--json");
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(nlohmann::json::parse(result.out)["crs"], "EPSG:32637");
  EXPECT_EQ(text_of(folder / "roads.pgw"), "2\n0\n0\n-2\n434001.000\n4179999.000\n");
  EXPECT_THAT(text_of(folder / "roads.png.aux.xml"), HasSubstr("EPSG:32637"));
}

TEST_F(DetectCommand, AFrameLiesNowhereWhateverWasThereBefore) {
  for (const char* name : {"roads.pgw", "roads.png.aux.xml", "roads.wld"}) std::ofstream(folder / name) << "of old";
  ASSERT_EQ(detect("--gsd 0.5").code, 0);
  for (const char* name : {"roads.pgw", "roads.png.aux.xml", "roads.wld"}) {
    EXPECT_FALSE(std::filesystem::exists(folder / name)) << name;
  }
}

TEST_F(DetectCommand, KeepsTheWorldFileOfTheFrame) {
  std::filesystem::copy(folder / "frame.png", folder / "roads.jpg");
  std::ofstream(folder / "roads.wld") << "of the frame";
  const ProgramResult result =
      run_program(folder.path(), fmt::format("detect --detector tree {} {} --gsd 0.5", (folder / "roads.jpg").string(),
                                             (folder / "roads.png").string()));
  EXPECT_EQ(result.code, 1);
  EXPECT_THAT(result.err, AllOf(HasSubstr("roads.wld belongs to"), HasSubstr("[target-is-source]")));
  EXPECT_EQ(text_of(folder / "roads.wld"), "of the frame");
}

TEST_F(DetectCommand, TakesEveryParameterOfTheTree) {
  const auto answer = nlohmann::json::parse(
      detect("--gsd 0.5 --json --tree-map binary --tree-roots 5000 --tree-min-nodes 2 --tree-alpha 0.4 --tree-beta 0.9 "
             "--tree-gamma 0.6 --tree-epsilon 2 --tree-edge 8 --tree-fan 5 --tree-fan-width 30 --tree-root-fan 12 "
             "--tree-nodes 50 --tree-explored 0.5 --tree-area 4000 --tree-min-score 0.01")
          .out);
  EXPECT_EQ(answer["made_by"]["detector"],
            "tree map=binary gsd_m=0.5 trees_per_km2=5000 min_nodes=2 alpha=0.4 beta=0.9 gamma=0.6 epsilon=2 edge_px=8 "
            "fan=5 fan_half_width_deg=30 root_fan=12 max_nodes=50 max_explored_share=0.5 max_area_px=4000 "
            "min_score=0.01");
  EXPECT_THAT(detect("--gsd 0.5 --tree-beta 0.7").err, HasSubstr("[tree-parameter]"));
  EXPECT_EQ(detect("--gsd 0.5 --tree-map sharp").code, 2);
  for (const char* name : {"--tree-gsd", "--tree-roots", "--tree-min-nodes", "--tree-nodes", "--tree-area"}) {
    for (const char* number : {"1e12", "0", "-3"}) {
      const ProgramResult refused = detect("--gsd 0.5 " + std::string(name) + " " + number);
      EXPECT_EQ(refused.code, 2) << name;
      EXPECT_THAT(refused.err, HasSubstr(std::string(name) + ": must be a number above 0 and at most 1"));
    }
  }
}

TEST_F(DetectCommand, EndsTreesAtTheirUsualNumberOfNodesOnlyWhereNoOtherEndIsGiven) {
  const auto detector = [&](const char* ends) {
    const auto answer = nlohmann::json::parse(detect(std::string("--gsd 0.5 --json ") + ends).out);
    return answer["made_by"]["detector"].get<std::string>();
  };
  EXPECT_THAT(detector("--tree-min-score 0.01"), HasSubstr("max_nodes=200"));
  EXPECT_THAT(detector("--tree-explored 0.1"), HasSubstr("max_nodes=- max_explored_share=0.1"));
  EXPECT_THAT(detector("--tree-area 900"), HasSubstr("max_nodes=- max_explored_share=- max_area_px=900"));
  EXPECT_THAT(detector("--tree-explored 0.1 --tree-nodes 50"), HasSubstr("max_nodes=50 max_explored_share=0.1"));
}

TEST_F(DetectCommand, NamesTheFileThatIsNoPicture) {
  std::ofstream(folder / "frame.png") << "II*, says a TIFF";
  const ProgramResult result = detect("--gsd 0.5");
  EXPECT_EQ(result.code, 1);
  EXPECT_THAT(result.err, AllOf(HasSubstr("frame.png: "), HasSubstr("gdal_translate"), HasSubstr("[image-format]")));
}

TEST_F(DetectCommand, MakesAFeatureMapOfEachPictureOfAFolderThatCanBeRead) {
  const std::filesystem::path photos = folder / "photos";
  std::filesystem::create_directory(photos);
  for (const char* name : {"1.png", "2.png"}) std::filesystem::copy_file(folder / "frame.png", photos / name);
  std::ofstream(photos / "0.jpg").flush();
  const std::string options = " --detector tree --gsd 0.5 --json";
  const ProgramResult result =
      run_program(folder.path(), "detect " + photos.string() + " " + (folder / "roads").string() + options);
  EXPECT_EQ(result.code, 1) << "one is left out";
  EXPECT_THAT(result.err, HasSubstr("0.jpg is left out: the file is empty: copy it again [image-damaged]\n"));
  EXPECT_EQ(std::ranges::count(result.out, '\n'), 2) << result.out;
  const auto first = nlohmann::json::parse(result.out.substr(0, result.out.find('\n')));
  EXPECT_EQ(first["image"], (photos / "1.png").string());
  EXPECT_EQ(first["feature_map"], (folder / "roads" / "1.png").string());
  EXPECT_TRUE(std::filesystem::exists(folder / "roads" / "1.png"));
  EXPECT_TRUE(std::filesystem::exists(folder / "roads" / "2.png"));
  EXPECT_FALSE(std::filesystem::exists(folder / "roads" / "0.png"));
  EXPECT_THAT(run_program(folder.path(), "detect " + photos.string() + " " + photos.string() + options).err,
              HasSubstr("[target-given-twice]"));
}

TEST_F(DetectCommand, SaysInOneLineThatANetworkCannotBeRun) {
  std::string onnx = text_of(ROADFIX_TEST_NETWORKS "/tiny.onnx");
  for (std::size_t at = onnx.find("Conv"); at != std::string::npos; at = onnx.find("Conv", at)) onnx[at] = 'X';
  std::ofstream(folder / "net.onnx", std::ios::binary) << onnx;
  std::ofstream(folder / "net.json") << R"({"name": "odd", "gsd_m": 1, "stride": 2, "multiple": 16, "tile_px": 512,
    "overlap_px": 32, "channels": "rgb", "mean": [100, 110, 120], "std": [50, 60, 70], "output": "logits"})";
  const ProgramResult result =
      run_program(folder.path(), "detect " + (folder / "frame.png").string() + " " + (folder / "roads.png").string() +
                                     " --gsd 1 --model " + (folder / "net.onnx").string());
  EXPECT_EQ(result.code, 1);
  EXPECT_THAT(result.err, HasSubstr("[model-"));
  EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
}

TEST_F(DetectCommand, SaysWhatIsMissing) {
  const ProgramResult nowhere = detect("");
  EXPECT_EQ(nowhere.code, 1);
  EXPECT_THAT(nowhere.err, AllOf(HasSubstr("Of a frame tell the scale: --gsd, --exif, or --agl"),
                                 HasSubstr("[image-without-georeference]")));
  EXPECT_EQ(detect("--fov 90").code, 2);
  EXPECT_EQ(detect("--agl 100").code, 2);
  EXPECT_EQ(detect("--fov 90 --focal-px 100 --agl 100").code, 2);
  EXPECT_EQ(detect("--fov 90 --agl 100 --distortion 0,0,0,0").code, 2);
  EXPECT_EQ(detect("--fov 90 --agl 100 --gsd 1").code, 2);
  EXPECT_THAT(detect("--fov 190 --agl 100").err, HasSubstr("[frame-camera]"));
}

TEST_F(DetectCommand, EndsAtASignalAsCommandsDoThatHaveNothingToStop) {
  const std::string pipe = (folder / "pipe").string();
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);  // from which nothing comes
  const std::string command = "timeout --preserve-status --kill-after 60 1 " ROADFIX_PROGRAM
                              " detect --detector tree " +
                              pipe + " " + (folder / "roads.png").string() + " --gsd 1";
  const int status = std::system(command.c_str());
  EXPECT_EQ(WEXITSTATUS(status), 128 + SIGTERM);
}

}  // namespace
}  // namespace roadfix
