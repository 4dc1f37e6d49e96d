// roadfix fix and match as a script meets them: exit codes, JSON on stdout, one line on stderr.
#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "core/detect/feature_map_codec.hpp"
#include "core/detect/tree_detector.hpp"
#include "tests/cli/localize_commands_fixture.hpp"
#include "tests/support/drone_jpeg.hpp"
#include "tests/support/put_block.hpp"
#include "tiles/store/map_writer.hpp"

namespace roadfix {
namespace {

using ::testing::HasSubstr;
using testing::LocalizeCommands;
using testing::ProgramResult;

TEST_F(LocalizeCommands, FixAnswersLikeTheService) {
  const ProgramResult whole = roadfix("fix --json " + input);
  ASSERT_EQ(whole.code, 0) << whole.err;
  const auto answer = nlohmann::json::parse(whole.out);
  ASSERT_EQ(answer["status"], "fix") << whole.out;
  EXPECT_NEAR(answer["pose"]["lat"].get<double>(), place.lat_deg, 2e-5);
  EXPECT_NEAR(answer["pose"]["lon"].get<double>(), place.lon_deg, 3e-5);
  EXPECT_NEAR(answer["pose"]["heading_deg"].get<double>(), heading_deg, 1.0);
  EXPECT_EQ(answer["map"]["name"], "town");
}

TEST_F(LocalizeCommands, FixSaysThatAnAnswerLongerThanABufferFindsNoRoom) {
  const std::string fix = "fix --json " + input;
  ASSERT_GT(roadfix(fix).out.size(), 4096U);
  const std::string err = folder / "err";
  EXPECT_EQ(WEXITSTATUS(std::system((ROADFIX_PROGRAM " " + fix + ">/dev/full 2>" + err).c_str())), 1);
  EXPECT_THAT(testing::text_of(err), HasSubstr("[output-unwritable]"));
}

TEST_F(LocalizeCommands, FixTellsAPersonWhatItsNumbersAre) {
  const ProgramResult result = roadfix("fix " + input);
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.out, ::testing::ContainsRegex("\n  lat 57\\.[0-9]+ lon [0-9.]+  heading [0-9.]+ "));
  EXPECT_THAT(result.out, HasSubstr("\npositions are WGS 84, headings from true north\n"));
}

TEST_F(LocalizeCommands, FixSaysThatAFileIsEmpty) {
  std::ofstream(window).flush();
  for (const char* kind : {"--cell 2", "", "--gsd 1 --detector tree", "--exif --detector tree"}) {
    const ProgramResult result = roadfix("fix " + map.string() + " " + window.string() + " " + kind);
    EXPECT_EQ(result.code, 1);
    EXPECT_EQ(result.err, "roadfix: " + window.string() + ": the file is empty: copy it again [image-damaged]\n");
  }
}

TEST_F(LocalizeCommands, FixSaysThatAnotherDetectorThanReadsFramesFoundTheRoads) {
  const std::string fix = "fix --detector tree " + map.string() + " " + window.string();
  save(encode_feature_map(what_is_seen(truth, 160), "neural roadnet-8 fnv1a64=1 gsd_m=1 orientations=1"), window);
  EXPECT_THAT(roadfix(fix).err, ::testing::AllOf(HasSubstr("window.png were found by neural roadnet-8"),
                                                 HasSubstr("again with --compare-with roads")));
  save(encode_feature_map(what_is_seen(truth, 160), TreeRoadDetector(TreeDetectorOptions()).describe()), window);
  EXPECT_EQ(roadfix(fix).err, "");
}

TEST_F(LocalizeCommands, FixIsAsAccurateAsTheNadirIsKnown) {
  const ProgramResult told = roadfix("fix --json " + input + "--nadir-sigma 30");
  ASSERT_EQ(told.code, 0) << told.err;
  EXPECT_GT(nlohmann::json::parse(told.out)["sigma_m"][1].get<double>(), 30.0);
  const ProgramResult exact = roadfix("fix --json " + input);
  EXPECT_LT(nlohmann::json::parse(exact.out)["sigma_m"][0].get<double>(), 10.0);
  for (const char* senseless : {"-1", "1001", "nan"}) {
    EXPECT_EQ(roadfix("fix " + input + "--nadir-sigma " + std::string(senseless)).code, 2) << senseless;
  }
}

TEST_F(LocalizeCommands, FixPutsTheUavWhereTheFeatureMapOrTheUserSays) {
  FeatureMap ahead = what_is_seen(truth, 160);  // of which only the part ahead is sent
  CellArray cells(160, 75);
  paste(ahead.cells, cells, 0, 0);
  ahead.cells = cells;
  save(encode_feature_map(ahead), window);
  save(encode_feature_map(ahead.cells), folder / "foreign.png");
  const std::string of_map = "fix --json " + map.string() + " ";
  for (const std::string& arguments :
       {window.string(), (folder / "foreign.png").string() + " --cell 2 --nadir 80,80"}) {
    const ProgramResult result = roadfix(of_map + arguments);
    ASSERT_EQ(result.code, 0) << result.err;
    const auto answer = nlohmann::json::parse(result.out);
    ASSERT_EQ(answer["status"], "fix") << result.out;
    EXPECT_NEAR(answer["pose"]["lat"].get<double>(), place.lat_deg, 2e-5) << arguments;
    EXPECT_NEAR(answer["pose"]["lon"].get<double>(), place.lon_deg, 3e-5) << arguments;
  }
  EXPECT_THAT(roadfix(of_map + window.string() + " --cell 1").err, HasSubstr("[cell-size-contradictory]"));
  EXPECT_THAT(roadfix(of_map + (folder / "foreign.png").string()).err, HasSubstr("[input-kind-missing]"));
}

TEST_F(LocalizeCommands, FixSaysWhichCameraItReadFromAPhoto) {
  const auto photo = testing::drone_jpeg(
      cv::Mat(90, 120, CV_8UC3, cv::Scalar(90, 120, 100)),
      R"(drone-dji:RelativeAltitude="+118.00" drone-dji:CalibratedFocalLength="100" )"
      R"(drone-dji:GimbalYawDegree="-90.00" drone-dji:GimbalRollDegree="+0.00" drone-dji:GimbalPitchDegree="-87.00")");
  save(photo, folder / "photo.jpg");
  const std::string of_photo = "fix --json --detector tree " + map.string() + " " + (folder / "photo.jpg").string();
  const ProgramResult result = roadfix(of_photo + " --exif");
  ASSERT_EQ(result.code, 0) << result.err;
  const auto camera = nlohmann::json::parse(result.out).at("camera");
  EXPECT_EQ(camera.at("agl_m"), 118.0);
  EXPECT_EQ(camera.at("focal_px"), 100.0);
  EXPECT_NEAR(camera.at("pitch_deg").get<double>(), 3.0, 1e-9);
  EXPECT_EQ(roadfix(of_photo + " --exif --black-unseen").code, 0);
  EXPECT_EQ(roadfix(of_photo + " --cell 2 --black-unseen").code, 2) << "says something of a frame, and there is none";
}

TEST_F(LocalizeCommands, FixMeasuresPhotosByTheGroundOfTheMapWhereThatOfTheirTakeOffIsTold) {
  const auto save_photo = [&](const char* name, const std::string& height) {
    cv::Mat pixels(400, 400, CV_8UC3);
    cv::randu(pixels, 0, 255);
    cv::GaussianBlur(pixels, pixels, {}, 4.0);
    save(testing::drone_jpeg(pixels, height + R"(drone-dji:CalibratedFocalLength="346.41" )"
                                              R"(drone-dji:GimbalYawDegree="0" drone-dji:GimbalPitchDegree="-90" )"
                                              R"(drone-dji:GimbalRollDegree="0")"),
         folder / "flight" / name);
  };
  std::filesystem::create_directory(folder / "flight");
  save_photo("a.jpg", R"(drone-dji:RelativeAltitude="+300.00" )");
  save_photo("b.jpg", R"(drone-dji:RelativeAltitude="+250.00" )");
  save_photo("c.jpg", R"(Camera:AboveGroundAltitude="100" )");
  const auto fix = [&](const std::string& name, const std::string& told) {
    return roadfix("fix " + map.string() + " " + (folder / "flight").string() + "/" + name + " --exif --json " +
                   at(place) + " --radius 100 " + told);
  };
  for (const char* told : {"--takeoff-alt 500", "--alt 800"}) {
    EXPECT_THAT(fix("", told).err, HasSubstr("roadfix: the map town does not know how high")) << told;
  }
  lay_level_ground(700.0);
  const auto by_takeoff = nlohmann::json::parse(fix("a.jpg", "--takeoff-alt 500").out);
  const auto by_height = nlohmann::json::parse(fix("a.jpg", "--agl 100").out);
  ASSERT_FALSE(by_takeoff["modes"].empty()) << by_takeoff;
  EXPECT_NEAR(by_takeoff["modes"][0]["agl_m"].get<double>(), 100.0, 1e-6);
  EXPECT_EQ(by_takeoff["modes"][0]["pose"], by_height["modes"][0]["pose"]);
  const auto by_altitude = nlohmann::json::parse(fix("a.jpg", "--alt 800").out);
  EXPECT_NEAR(by_altitude["camera"]["agl_m"].get<double>(), 100.0, 1e-6) << "whatever its file says";
  EXPECT_EQ(by_altitude["modes"], by_takeoff["modes"]);
  const ProgramResult all = fix("", "--takeoff-alt 500");
  EXPECT_EQ(all.code, 1);
  std::istringstream lines(all.out);
  for (const double agl_m : {100.0, 50.0}) {
    std::string line;
    std::getline(lines, line);
    EXPECT_NEAR(nlohmann::json::parse(line)["camera"]["agl_m"].get<double>(), agl_m, 1e-6) << "each has its own";
  }
  EXPECT_THAT(all.err, HasSubstr("c.jpg is left out: the picture's file does not tell its height above the take-off"));
  EXPECT_THAT(fix("b.jpg", "--takeoff-alt 400").err, HasSubstr("[below-ground]"));
  for (const char* told_twice : {"--agl 100", "--alt 800"}) {
    EXPECT_EQ(fix("a.jpg", std::string("--takeoff-alt 500 ") + told_twice).code, 2) << told_twice;
  }
  EXPECT_EQ(roadfix("fix " + input + "--takeoff-alt 500").code, 2) << "of a feature map";
}

TEST_F(LocalizeCommands, FixMeasuresAFrameByTheGroundOfTheMapWhereItsHeightAboveTheSeaIsTold) {
  const std::string frame = folder / "frame.png";
  cv::Mat pixels(400, 400, CV_8UC3);
  cv::randu(pixels, 0, 255);
  cv::GaussianBlur(pixels, pixels, {}, 4.0);
  cv::imwrite(frame, pixels);
  const auto fix = [&](const std::string& height) {
    return roadfix("fix " + map.string() + " " + frame + " --fov 60 --json " + at(place) + " --radius 100 " + height);
  };
  EXPECT_THAT(fix("--alt 1000").err, HasSubstr("[terrain-missing]"));
  lay_level_ground(700.0);
  EXPECT_THAT(fix("--alt 600").err, HasSubstr("[below-ground]"));
  const auto by_altitude = nlohmann::json::parse(fix("--alt 1000").out);
  const auto by_height = nlohmann::json::parse(fix("--agl 300").out);
  ASSERT_FALSE(by_altitude["modes"].empty()) << by_altitude;
  EXPECT_NEAR(by_altitude["modes"][0]["agl_m"].get<double>(), 300.0, 1e-6);
  EXPECT_EQ(by_altitude["modes"][0]["pose"], by_height["modes"][0]["pose"]);
  for (const char* besides : {"--agl 300", "--gsd 1", "--cell 2"}) {
    EXPECT_EQ(fix(std::string("--alt 1000 ") + besides).code, 2) << besides;
  }
  EXPECT_EQ(fix("").code, 2) << "a lens without a height";
}

TEST_F(LocalizeCommands, FixNotesThatAFrameIsReadByAnotherDetectorThanTheMap) {
  const auto photo = testing::drone_jpeg(cv::Mat(90, 120, CV_8UC3, cv::Scalar(90, 120, 100)), "");
  save(photo, folder / "frame.jpg");
  const std::string frame = " " + (folder / "frame.jpg").string() + " --gsd 2 --detector tree";
  EXPECT_EQ(roadfix("fix " + map.string() + frame).err.find("was read by"), std::string::npos) << "it is of road data";
  SourceRecord imagery{.name = "imagery",
                       .content = SourceContent::kImagery,
                       .fingerprint = "1",
                       .method = "neural x fnv1a64=1 gsd_m=1; 1"};
  {
    MapWriter writer(map, {zone, 2.0});
    const auto blocks = tiles_covering(town.geometry);
    for (const TileIndex block : writer.begin_source(imagery, blocks, false)) {
      testing::put_block(writer, imagery.name, block, CellArray(kTileCells, kTileCells, kNoRoad));
    }
    writer.finish_source(imagery.name);
  }
  EXPECT_THAT(roadfix("fix " + map.string() + frame).err, HasSubstr("note: town was read by neural x fnv1a64=1"));
}

TEST_F(LocalizeCommands, FixTakesAPrior) {
  const ProgramResult near = roadfix("fix " + input + at(place) + " --radius 100 --heading 217 --heading-range 20");
  EXPECT_EQ(near.code, 0) << near.err;
  EXPECT_THAT(near.out, HasSubstr("fix  probability"));
  const ProgramResult far = roadfix("fix " + input + "--lat 50 --lon 21 --radius 100");
  EXPECT_EQ(far.code, 1);
  EXPECT_THAT(far.err, HasSubstr("[prior-outside-map]"));
  EXPECT_EQ(roadfix("fix " + input + "--lat 50").code, 2);
  EXPECT_EQ(roadfix("fix " + input + "--bbox 1,2,3").code, 2);
  const ProgramResult swapped = roadfix("fix " + input + "--bbox 50,20,51,20");
  EXPECT_EQ(swapped.code, 2);
  EXPECT_THAT(swapped.err, HasSubstr("--bbox: west must lie below east, and south below north"));
  EXPECT_EQ(roadfix("fix " + input + "--bbox 0,-100,10,100").code, 2) << "as the service refuses it";
  const ProgramResult box = roadfix("fix " + input + "--bbox 20,50,21,51");
  EXPECT_THAT(box.err, HasSubstr("prior-outside-map"));
}

TEST_F(LocalizeCommands, FixLaysWindowsAlongAFlightTogether) {
  std::string also;
  for (const double forward_m : {-80.0, -160.0}) {
    const GridPose earlier{{truth.position.east_m + sin(truth.heading) * forward_m,
                            truth.position.north_m + cos(truth.heading) * forward_m},
                           truth.heading + Angle::degrees(10)};
    const auto file = folder / ("window" + std::to_string(forward_m) + ".png");
    save_what_is_seen(earlier, 80, file);
    also += " --also " + file.string() + "," + std::to_string(forward_m) + ",0,10";
  }
  save_what_is_seen(truth, 80, window);
  const ProgramResult alone = roadfix("fix --json " + input);
  const ProgramResult together = roadfix("fix --json " + input + also);
  ASSERT_EQ(together.code, 0) << together.err;
  const auto answer = nlohmann::json::parse(together.out);
  const auto cells = [](const nlohmann::json& json) { return json["modes"][0]["observed_cells"].get<int>(); };
  EXPECT_GT(cells(answer), 1.5 * cells(nlohmann::json::parse(alone.out)));
  const auto& best = answer["modes"][0];
  EXPECT_NEAR(best["pose"]["lat"].get<double>(), place.lat_deg, 3e-5);
  EXPECT_NEAR(best["pose"]["lon"].get<double>(), place.lon_deg, 5e-5);
  EXPECT_THAT(together.err, ::testing::Not(HasSubstr("left out")));
  const auto strayed = folder / "strayed.png";
  save_what_is_seen(moved(truth, {-40.0, 0.0, {}}), 80, strayed);
  const ProgramResult rest = roadfix("fix --json " + input + also + " --also " + strayed.string() + ",-40,70,0");
  EXPECT_THAT(rest.err, HasSubstr("note: left out frame 4, " + strayed.string() + ": it contradicts the others"));
  const auto answer_of_rest = nlohmann::json::parse(rest.out);
  EXPECT_EQ(answer_of_rest["left_out"], nlohmann::json::array({4}));
  EXPECT_EQ(answer_of_rest["modes"], answer["modes"]);
  EXPECT_THAT(roadfix("fix " + input + "--also " + window.string() + ",1,2").err, HasSubstr("[also-unreadable]"));
  EXPECT_THAT(roadfix("fix " + input + "--also " + window.string() + ",9e5,0,0").err,
              HasSubstr("[frames-too-far-apart]"));
}

TEST_F(LocalizeCommands, FixRefusesWhatItCannotRead) {
  EXPECT_THAT(roadfix("fix " + map.string() + " " + window.string()).err, HasSubstr("[input-kind-missing]"));
  EXPECT_THAT(roadfix("fix " + map.string() + " nowhere.png --cell 2").err, HasSubstr("[file-not-found]"));
  EXPECT_THAT(roadfix("fix " + map.string() + " " + map.string() + " --cell 2").err, HasSubstr("[image-format]"));
  EXPECT_EQ(roadfix("fix " + input + "--gsd 1").code, 2);
}

TEST_F(LocalizeCommands, FixNamesTheOptionWithANumberThatMakesNoSense) {
  for (const char* option : {"--time-limit 1e300", "--proof 0", "--lat 50 --lon 20 --radius -3", "--cell 0,5"}) {
    const ProgramResult refused = roadfix("fix " + map.string() + " " + window.string() + " " + option);
    EXPECT_EQ(refused.code, 2) << option;
    EXPECT_THAT(refused.err, HasSubstr("must be a number above 0 and at most 2000000000, not ")) << option;
  }
  const ProgramResult detector = roadfix("fix " + input + "--detector forest");
  EXPECT_EQ(detector.code, 2) << "though a feature map needs none";
  EXPECT_THAT(detector.err, HasSubstr("neural"));
}

TEST_F(LocalizeCommands, MatchScoresPosesFromOptionsAndFile) {
  std::ofstream(folder / "poses.csv") << "\xef\xbb\xbflat,lon,heading\n"
                                      << place.lat_deg + 0.001 << ", " << place.lon_deg << ", 10\n\n";
  const std::string pose =
      std::to_string(place.lat_deg) + "," + std::to_string(place.lon_deg) + "," + std::to_string(heading_deg);
  const ProgramResult result =
      roadfix("match --json " + input + "--pose " + pose + " --poses " + (folder / "poses.csv").string());
  ASSERT_EQ(result.code, 0) << result.err;
  const auto matches = nlohmann::json::parse(result.out)["scores"];
  ASSERT_EQ(matches.size(), 2U);
  EXPECT_GT(matches[0]["rho"].get<double>(), 0.6);
  EXPECT_LT(matches[1]["rho"].get<double>(), 0.4);
  EXPECT_THAT(roadfix("match " + input + "--pose 57.7,12").err, HasSubstr("[pose-unreadable]"));
  EXPECT_THAT(roadfix("match " + input + "--heading-step 5 --pose 57.7,12,inf").err, HasSubstr("[pose-unreadable]"));
  EXPECT_EQ(roadfix("match " + input + "--heading-step 90 --pose 57.7,12,0").code, 0) << "as the service takes it";
  EXPECT_EQ(roadfix("fix " + input + "--confidence 0.4").code, 2) << "as the service refuses it";
  EXPECT_THAT(roadfix("match " + input).err, HasSubstr("[poses-missing]"));
}

}  // namespace
}  // namespace roadfix
