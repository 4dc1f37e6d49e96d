// The bench as a whole over a drawn town whose detector makes no mistakes: everything must be found.
#include "cli/bench/run.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stop_token>

#include "core/detect/frame_camera.hpp"
#include "core/units/error.hpp"
#include "tests/support/street_map.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roadfix::bench {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr int kCells = 350;
constexpr double kGsdM = 1.0;

/// Bright is road.
class BrightnessDetector : public RoadDetector {
 public:
  CellArray detect(const GroundImage& image, double cell_m, std::uint64_t, const std::stop_token&) const override {
    const cv::Mat observed = observed_cells(image, cell_m);
    cv::Mat grey;
    cv::extractChannel(image.pixels, grey, 0);
    cv::resize(grey, grey, observed.size(), 0, 0, cv::INTER_AREA);
    CellArray cells(observed.cols, observed.rows);
    for (int row = 0; row < cells.rows(); ++row) {
      for (int col = 0; col < cells.cols(); ++col) {
        if (observed.at<uchar>(row, col) != 0) cells.at(col, row) = grey.at<uchar>(row, col) > 160 ? kRoad : kNoRoad;
      }
    }
    return cells;
  }
  double preferred_gsd_m() const override { return kGsdM; }
  double halo_m() const override { return 0.0; }
  std::string describe() const override { return "brightness"; }
};

/// Half a square kilometre of streets at 1 m, in UTM 34 north, as a picture with world file.
class BenchRun : public ::testing::Test {
 protected:
  BenchRun() {
    const RoadGrid town = testing::street_map(5, {2.0, {200'000, -2'000'000}, kCells, kCells});
    cv::Mat picture(2 * kCells, 2 * kCells, CV_8UC3);
    cv::randu(picture, 0, 140);
    cv::GaussianBlur(picture, picture, {}, 2.5);
    cv::normalize(picture, picture, 0, 140, cv::NORM_MINMAX);  // a texture that every keypoint detector sees
    for (int y = 0; y < picture.rows; ++y) {
      for (int x = 0; x < picture.cols; ++x) {
        if (town.cells.at(x / 2, y / 2) == kRoad) picture.at<cv::Vec3b>(y, x) = {230, 230, 230};
      }
    }
    cv::Mat grain(picture.size(), CV_8UC3);
    cv::randu(grain, 0, 8);
    picture += grain;  // no sensor sees ground in one colour
    cv::imwrite(folder / "town.png", picture);
    std::ofstream(folder / "town.pgw") << "1\n0\n0\n-1\n400000.5\n3999999.5\n";
    std::ofstream(folder / "town.png.aux.xml") << "<PAMDataset><SRS>EPSG:32634</SRS></PAMDataset>";
    cv::imwrite(folder / "frame.png", picture(cv::Rect(200, 300, 300, 300)));
    // The frame's centre, (400350, 3999550) on the plane of the zone, north up on the grid.
    const UtmZone zone = UtmZone::from_epsg(32634).value();
    const LatLon centre = zone.unproject({400350.0, 3999550.0});
    std::ofstream(folder / "frames.csv") << "file,lat,lon,heading_deg,gsd_m\nframe.png,"
                                         << std::to_string(centre.lat_deg) << ',' << std::to_string(centre.lon_deg)
                                         << ',' << zone.true_from_grid({}, {400350.0, 3999550.0}).degrees() << ",1\n";
    options.jobs = 2;
    options.maps = {&detector, 2.0, 1, 2, folder.path(), [](const std::string&, std::int64_t, std::int64_t) {}, {}};
    options.progress = [](const std::string&, std::int64_t, std::int64_t) {};
  }

  std::vector<SetResult> run(const std::string& queries, const std::string& methods) const {
    const std::string text = R"({"maps": [{"name": "town", "sources": [{"path": "town.png", "as": "imagery"}]}],
        "queries": [)" + queries +
                             R"(], "methods": [)" + methods + "]}";
    return bench::run(parse_manifest(text, folder.path()), options);
  }

  testing::TemporaryFolder folder;
  BrightnessDetector detector;
  BenchOptions options;
};

constexpr const char* kImageQueries = R"({"map": "town", "image": "town.png", "count": 3, "footprint_m": [300, 240]})";

TEST_F(BenchRun, PlacesFramesCutFromTheMapsOwnImageryByEveryMethod) {
  for (const SetResult& result : run(kImageQueries, R"("roads", "sift", "orb")")) {
    const Summary s = summary_of(result.outcomes);
    EXPECT_EQ(s.n, 3) << result.method;
    EXPECT_EQ(s.recall_5, 1.0) << result.method;
    EXPECT_EQ(s.false_fixes, 0) << result.method;
    if (result.method == "roads") {
      EXPECT_GT(s.median_rho_at_truth.value_or(0.0), 0.8);
    } else {
      EXPECT_GT(s.mean_right_matches.value_or(0.0), 0.8 * s.mean_matches.value_or(1e9)) << result.method;
    }
    for (const Outcome& outcome : result.outcomes) {
      EXPECT_LT(outcome.heading_error_deg.value_or(360.0), 1.0) << result.method;
    }
  }
}

TEST_F(BenchRun, DrawsEveryQueryWhereAFolderIsNamed) {
  options.pictures = folder / "pictures";
  options.limit = 1;
  run(kImageQueries, R"("roads", "sift")");
  for (const char* file : {"1-roads/town/0000.jpg", "1-sift/town/0000.jpg"}) {
    const cv::Mat picture = cv::imread(options.pictures / file);
    ASSERT_FALSE(picture.empty()) << file;
    EXPECT_GT(picture.cols, picture.rows) << file;
  }
}

TEST_F(BenchRun, SaysThatAPictureCannotBeWritten) {
  std::ofstream(folder / "pictures") << "a file";
  options.pictures = folder / "pictures";
  options.limit = 1;
  EXPECT_THAT([&] { run(kImageQueries, R"("roads")"); }, ThrowsMessage<IoFailure>(HasSubstr("pictures")));
}

TEST_F(BenchRun, PlacesSimulatedFeatureMapsAndRealFrames) {
  const auto results = run(R"({"map": "town", "image": null, "count": 3, "footprint_m": [300, 300],
                               "noise": {"erase": 0.1, "invent": 0.1}, "prior": {"radius_m": 300}},
                              {"map": "town", "frames": "frames.csv"})",
                           R"("roads")");
  ASSERT_EQ(results.size(), 2u);
  EXPECT_EQ(results[0].outcomes.size(), 3u);
  EXPECT_EQ(summary_of(results[0].outcomes).recall_5, 1.0);
  EXPECT_EQ(results[1].outcomes.at(0).id, "frame.png");
  EXPECT_LT(*results[1].outcomes.at(0).error_m, 3.0);
  EXPECT_LT(*results[1].outcomes.at(0).heading_error_deg, 1.0);
}

TEST_F(BenchRun, LaysFramesOfOneSequenceTogetherByTheirPoses) {
  const UtmZone zone = UtmZone::from_epsg(32634).value();
  const cv::Mat picture = cv::imread(folder / "town.png");
  std::ofstream csv(folder / "flight.csv");
  csv << std::setprecision(10) << "sequence,file,lat,lon,heading_deg,gsd_m\n";
  for (int i = 0; i < 3; ++i) {
    cv::Mat frame = picture(cv::Rect(200 + 70 * i, 300, 110, 110)).clone();
    if (i == 1) cv::rotate(frame, frame, cv::ROTATE_90_CLOCKWISE);  // its forward edge looks west
    const std::string name = "flight" + std::to_string(i) + ".png";
    cv::imwrite(folder / name, frame);
    const GridPoint centre{400255.0 + 70 * i, 3999645.0};
    const LatLon at = zone.unproject(centre);
    csv << "a," << name << ',' << at.lat_deg << ',' << at.lon_deg << ','
        << zone.true_from_grid(Angle::degrees(i == 1 ? -90.0 : 0.0), centre).degrees() << ",1\n";
  }
  csv.close();
  const auto results = run(R"({"map": "town", "frames": "flight.csv", "together": 3})", R"("roads")");
  EXPECT_EQ(results.at(0).query_set, "flight.csv 3 together");
  EXPECT_LT(*results[0].outcomes.at(2).error_m, 3.0);
  EXPECT_LT(*results[0].outcomes.at(2).heading_error_deg, 1.0);
}

/// What a camera above a place of the plane takes of the town, whose picture begins at (400000, 4000000).
cv::Mat taken_over(const cv::Mat& town, const GridPose& pose, const FrameCamera& camera, cv::Size size) {
  const Lens lens = lens_of(camera, size);
  cv::Mat places(size, CV_32FC2);
  for (int row = 0; row < size.height; ++row) {
    for (int col = 0; col < size.width; ++col) {
      const cv::Point2d ground = ground_of(camera, lens.ray_of({col + 0.5, row + 0.5}).value()).value();
      const GridPoint at = moved(pose, {-ground.y, ground.x, {}}).position;
      places.at<cv::Point2f>(row, col) = cv::Point2d(at.east_m - 400000.0 - 0.5, 4000000.0 - at.north_m - 0.5);
    }
  }
  cv::Mat frame;
  cv::remap(town, frame, places, {}, cv::INTER_LINEAR, cv::BORDER_CONSTANT);
  return frame;
}

TEST_F(BenchRun, PlacesTheUavOfFramesThatTheirCameraDescribes) {
  const UtmZone zone = UtmZone::from_epsg(32634).value();
  const GridPose truth{{400330.0, 3999620.0}, Angle::degrees(40)};
  FrameCamera camera;
  camera.focal_px = 400.0;
  camera.agl_m = 250.0;
  camera.roll = Angle::degrees(-5);
  camera.pitch = Angle::degrees(8);
  camera.distortion = {-0.2, 0.05, 0.0, 0.0};
  cv::imwrite(folder / "oblique.png", taken_over(cv::imread(folder / "town.png"), truth, camera, {500, 400}));
  const LatLon at = zone.unproject(truth.position);
  std::ofstream(folder / "oblique.csv") << std::setprecision(10)
                                        << "file,lat,lon,heading_deg,agl_m,focal_px,roll_deg,pitch_deg,distortion\n"
                                        << "oblique.png," << at.lat_deg << ',' << at.lon_deg << ','
                                        << zone.true_from_grid(truth.heading, truth.position).degrees()
                                        << ",250,400,-5,8,-0.2 0.05 0 0\n";
  for (const SetResult& result : run(R"({"map": "town", "frames": "oblique.csv"})", R"("roads", "sift")")) {
    const Outcome& outcome = result.outcomes.at(0);
    EXPECT_LT(outcome.error_m.value(), 3.0) << result.method;
    EXPECT_LT(outcome.heading_error_deg.value(), 1.0) << result.method;
    if (result.method != "roads") continue;
    EXPECT_GE(outcome.answer.mode.value().sigma_m[1], 250.0 * kToldAttitudeSigma.radians())
        << "how well the attitude is known is part of the accuracy";
  }
}

TEST_F(BenchRun, NamesTheFrameWhoseCameraCannotBe) {
  std::ofstream(folder / "level.csv") << "file,lat,lon,heading_deg,agl_m,fov_deg,pitch_deg\n"
                                         "frame.png,36.13,19.89,0,250,60,89\n";
  EXPECT_THAT([&] { run(R"({"map": "town", "frames": "level.csv", "elsewhere": true})", R"("roads")"); },
              ThrowsMessage<InvalidInput>(HasSubstr("frame.png: ")));
}

TEST_F(BenchRun, CountsEveryFixOfGroundThatIsNotOnTheMapAsFalse) {
  const Manifest manifest = parse_manifest(R"({
    "maps": [{"name": "town", "sources": [{"path": "town.png", "as": "imagery"}]},
             {"name": "other", "sources": [{"as": "invented", "seed": 3, "side_m": 800}]}],
    "queries": [{"map": "town", "from": "other", "elsewhere": true, "image": null, "count": 2, "footprint_m": [200, 200]},
                {"map": "other", "image": null, "count": 2, "footprint_m": [400, 400]}],
    "methods": ["roads"]})",
                                           folder.path());
  const auto results = bench::run(manifest, options);
  ASSERT_EQ(results.size(), 2u);
  for (const Outcome& outcome : results[0].outcomes) {
    EXPECT_FALSE(outcome.truth);
    EXPECT_TRUE(!outcome.error_m || std::isinf(*outcome.error_m));
  }
  const Summary elsewhere = summary_of(results[0].outcomes);
  EXPECT_EQ(elsewhere.recall_50, 0.0);
  EXPECT_EQ(elsewhere.false_fixes, elsewhere.answered);
  EXPECT_EQ(summary_of(results[1].outcomes).recall_5, 1.0);
}

TEST_F(BenchRun, AsksImageryAndFramesOfAnotherContinentThatAreElsewhere) {
  std::filesystem::copy_file(folder / "town.png", folder / "far.png");
  std::filesystem::copy_file(folder / "town.pgw", folder / "far.pgw");
  std::ofstream(folder / "far.png.aux.xml") << "<PAMDataset><SRS>EPSG:32721</SRS></PAMDataset>";
  std::ofstream(folder / "far.csv") << "sequence,file,lat,lon,heading_deg,gsd_m\n"
                                       "a,frame.png,-34.9,-56.2,0,1\na,frame.png,-34.9,-56.2,0,1\n";
  const auto results = run(R"({"map": "town", "image": "far.png", "count": 2, "footprint_m": [300, 300],
                               "elsewhere": true},
                              {"map": "town", "frames": "far.csv", "together": 2, "elsewhere": true})",
                           R"("roads")");
  ASSERT_EQ(results.size(), 2u);
  for (const SetResult& result : results) {
    const Summary s = summary_of(result.outcomes);
    EXPECT_EQ(s.n, 2) << result.query_set;
    EXPECT_GT(s.answered, 0) << result.query_set;  // it is the picture of the town, wherever it is said to be
    EXPECT_EQ(s.false_fixes, s.answered) << result.query_set;
  }
}

TEST_F(BenchRun, RefusesToLookForAPlaceOfAnotherZone) {
  const Manifest manifest = parse_manifest(R"({
    "maps": [{"name": "town", "sources": [{"path": "town.png", "as": "imagery"}]},
             {"name": "other", "sources": [{"as": "invented", "seed": 3, "side_m": 800}]}],
    "queries": [{"map": "town", "from": "other", "image": null, "count": 2, "footprint_m": [200, 200]}],
    "methods": ["roads"]})",
                                           folder.path());
  EXPECT_THAT([&] { bench::run(manifest, options); }, ThrowsMessage<InvalidInput>(HasSubstr("UTM zones")));
}

TEST_F(BenchRun, GivesTheSameAnswersWithAnotherNumberOfJobsAndAFoundMap) {
  const auto first = run(kImageQueries, R"("roads", "sift")");
  options.jobs = 1;
  options.limit = 2;
  const auto second = run(kImageQueries, R"("roads", "sift")");
  for (std::size_t method = 0; method < 2; ++method) {
    ASSERT_EQ(second[method].outcomes.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(first[method].outcomes[i].error_m, second[method].outcomes[i].error_m) << first[method].method;
      EXPECT_EQ(first[method].outcomes[i].answer.probability, second[method].outcomes[i].answer.probability);
    }
  }
}

TEST_F(BenchRun, AsksTheOtherSetsWhereAFootprintFitsNowhere) {
  std::vector<std::string> left_out;
  options.left_out = [&](const std::string& why) { left_out.push_back(why); };
  const auto results = run(
      std::string(R"({"map": "town", "image": "town.png", "count": 1, "footprint_m": [2000, 100]}, )") + kImageQueries,
      "\"roads\"");
  EXPECT_THAT(left_out, ::testing::ElementsAre(HasSubstr("2000 x 100 m")));
  ASSERT_EQ(results.size(), 1U);
  EXPECT_EQ(results[0].outcomes.size(), 3U);
}

TEST_F(BenchRun, LooksAtNothingThatIsPaintedWithoutBeingMarked) {
  cv::Mat picture = cv::imread(folder / "town.png");
  picture.colRange(0, 320).setTo(cv::Scalar::all(255));
  cv::imwrite(folder / "painted.png", picture);
  std::filesystem::copy_file(folder / "town.pgw", folder / "painted.pgw");
  std::filesystem::copy_file(folder / "town.png.aux.xml", folder / "painted.png.aux.xml");
  const auto results =
      run(R"({"map": "town", "image": "painted.png", "count": 6, "footprint_m": [200, 200]})", "\"roads\"");
  for (const Outcome& outcome : results.at(0).outcomes) {
    const GridPoint at = UtmZone::from_epsg(32634).value().project(outcome.truth.value().position);
    EXPECT_GT(at.east_m, 400'000 + 320 + 100);
  }
}

TEST_F(BenchRun, KeepsMapsOfTheSameNameApart) {
  const auto other = folder / "other";
  std::filesystem::create_directory(other);
  for (const char* file : {"town.png", "town.pgw", "town.png.aux.xml"}) {
    std::filesystem::copy_file(folder / file, other / file);
  }
  cv::imwrite(other / "town.png", cv::imread(folder / "town.png") / 2);
  const MapBuilding& building = options.maps;
  const MapView here = build_map({"town", {{folder / "town.png", "imagery"}}}, building);
  const MapView there = build_map({"town", {{other / "town.png", "imagery"}}}, building);
  const MapView both =
      build_map({"town", {{folder / "town.png", "imagery"}, {other / "town.png", "imagery"}}}, building);
  EXPECT_NE(here.version, there.version);
  EXPECT_NE(here.version, both.version);
  EXPECT_EQ(here.version, build_map({"town", {{folder / "town.png", "imagery"}}}, building).version);
}

TEST_F(BenchRun, MapsBothSidesOfTheEquator) {
  std::ofstream(folder / "town.pgw") << "1\n0\n0\n-1\n400000.5\n349.5\n";
  const MapView map = build_map({"town", {{folder / "town.png", "imagery"}}}, options.maps);
  EXPECT_FALSE(map.zone.northern());
  EXPECT_NEAR(map.extent.height_m(), 700.0, 4.0);
}

TEST_F(BenchRun, StopsWhenAsked) {
  std::stop_source stop;
  stop.request_stop();
  options.maps.stop = stop.get_token();
  EXPECT_THROW(run(kImageQueries, "\"roads\""), Interrupted);
}

}  // namespace
}  // namespace roadfix::bench
