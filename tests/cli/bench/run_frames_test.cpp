// The bench over frames that were taken and described by others.
#include <gmock/gmock.h>

#include <atomic>
#include <fstream>
#include <iomanip>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "core/detect/frame_camera.hpp"
#include "core/grid/relief.hpp"
#include "core/locate/told_frames.hpp"
#include "tests/cli/bench/bench_run.hpp"
#include "tests/support/sloping_ground.hpp"
#include "tests/support/taken_over.hpp"

namespace roadfix::bench {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

using BenchRunOfFrames = BenchRun;

/// Three frames from above the town, whose picture begins at (400000, 4000000), each 70 m east of the one before; or
/// the first of them at all three places, of a camera that has stopped.
void take_flight(const std::filesystem::path& folder, bool camera_has_stopped = false) {
  const UtmZone zone = UtmZone::from_epsg(32634).value();
  const cv::Mat picture = cv::imread(folder / "town.png");
  std::ofstream csv(folder / "flight.csv");
  csv << std::setprecision(10) << "sequence,file,lat,lon,heading_deg,gsd_m\n";
  for (int i = 0; i < 3; ++i) {
    cv::Mat frame = picture(cv::Rect(200 + (camera_has_stopped ? 0 : 70 * i), 300, 110, 110)).clone();
    if (i == 1) cv::rotate(frame, frame, cv::ROTATE_90_CLOCKWISE);  // its forward edge looks west
    const std::string name = "flight" + std::to_string(i) + ".png";
    cv::imwrite(folder / name, frame);
    const GridPoint centre{400255.0 + 70 * i, 3999645.0};
    const LatLon at = zone.unproject(centre);
    csv << "a," << name << ',' << at.lat_deg << ',' << at.lon_deg << ','
        << zone.true_from_grid(Angle::degrees(i == 1 ? -90.0 : 0.0), centre).degrees() << ",1\n";
  }
}

TEST_F(BenchRunOfFrames, LaysFramesOfOneSequenceTogetherByTheirPoses) {
  take_flight(folder.path());
  const auto results = run(R"({"map": "town", "frames": "flight.csv", "together": 3})", R"("roads")");
  EXPECT_EQ(results.at(0).query_set, "flight.csv 3 together");
  const Outcome& outcome = results[0].outcomes.at(2);
  EXPECT_LT(*outcome.error_m, 3.0);
  EXPECT_LT(*outcome.heading_error_deg, 1.0);
  EXPECT_GE(outcome.answer.mode.value().ellipse.sigma_m[1], 70.0 * kToldOffsetShare) << "of offsets that somebody told";
}

class CountingDetector : public BrightnessDetector {
 public:
  using RoadDetector::detect;
  CellArray detect(const GroundImage& image, double cell_m, std::uint64_t seed,
                   const std::stop_token& stop) const override {
    if (image.pixels.size() == cv::Size(110, 110)) ++frames;
    return BrightnessDetector::detect(image, cell_m, seed, stop);
  }
  mutable std::atomic<int> frames = 0;
};

TEST_F(BenchRunOfFrames, LooksForRoadsOnceInAFrameThatIsPartOfSeveralQueries) {
  take_flight(folder.path());
  const auto counter = std::make_shared<CountingDetector>();
  const Detectors counting(counter);
  options.detectors = &counting;
  options.jobs = 1;
  const auto results = run(R"({"map": "town", "frames": "flight.csv", "together": 3})", R"("roads")");
  EXPECT_EQ(counter->frames, 3);
  for (const Outcome& outcome : results.at(0).outcomes) EXPECT_GT(outcome.answer.time_ms, 0.0);
}

TEST_F(BenchRunOfFrames, GivesNoFixWhereTheCameraHasStopped) {
  take_flight(folder.path(), true);
  const auto results = run(R"({"map": "town", "frames": "flight.csv", "together": 3})", R"("roads")");
  EXPECT_EQ(results.at(0).outcomes.at(2).answer.reason, "frames-repeated");
  EXPECT_EQ(results[0].outcomes[2].answer.status, FixStatus::kNoFix);
}

/// One frame of a tilted camera with a distorting lens, 250 m above a place where the town lies to all sides.
class BenchRunOfACamera : public BenchRun {
 protected:
  BenchRunOfACamera() { take_frame(); }

  void take_frame(const std::optional<Relief>& relief = {}) const { take_frame("oblique.png", truth, 250.0, relief); }
  void take_frame(const char* name, const GridPose& pose, double agl_m, const std::optional<Relief>& relief) const {
    FrameCamera camera;
    camera.focal_px = 400.0;
    camera.agl_m = agl_m;
    camera.roll = Angle::degrees(-5);
    camera.pitch = Angle::degrees(8);
    camera.distortion = {-0.2, 0.05, 0.0, 0.0};
    const Orthoimage town{{cv::imread(folder / "town.png"), {}, 1.0}, {400000.0, 4000000.0}};
    cv::imwrite(folder / name, testing::taken_over(town, pose, camera, {500, 400}, relief));
  }

  struct Described {
    const char* name;
    GridPose pose;
    double height_m;
  };

  /// `height`: the name of its column.
  void describe_frame(const std::string& height, double height_m) const {
    describe_frames(height, {{"oblique.png", truth, height_m}});
  }
  void describe_frames(const std::string& height, const std::vector<Described>& frames) const {
    const UtmZone zone = UtmZone::from_epsg(32634).value();
    std::ofstream csv(folder / "oblique.csv");
    csv << std::setprecision(10) << "file,lat,lon,heading_deg," << height
        << ",focal_px,roll_deg,pitch_deg,distortion\n";
    for (const auto& [name, pose, height_m] : frames) {
      const LatLon at = zone.unproject(pose.position);
      csv << name << ',' << at.lat_deg << ',' << at.lon_deg << ','
          << zone.true_from_grid(pose.heading, pose.position).degrees() << ',' << height_m
          << ",400,-5,8,-0.2 0.05 0 0\n";
    }
  }

  /// The ground of write_elevation_model().
  Terrain slope() const {
    return testing::SlopingGround{grown({truth.position, truth.position}, 2000.0),
                                  height_m({truth.position.east_m - 2000.0, 0.0}),
                                  height_m({truth.position.east_m + 2000.0, 0.0})}
        .terrain();
  }

  const GridPose truth{{400330.0, 3999620.0}, Angle::degrees(40)};
};

TEST_F(BenchRunOfACamera, PlacesTheUav) {
  describe_frame("agl_m", 250.0);
  const auto results = run(R"({"map": "town", "frames": "oblique.csv"})", R"("roads", "sift")");
  ASSERT_EQ(results.size(), 2U);
  for (const SetResult& result : results) {
    const Outcome& outcome = result.outcomes.at(0);
    EXPECT_LT(outcome.error_m.value(), 3.0) << to_string(result.method);
    EXPECT_LT(outcome.heading_error_deg.value(), 1.0) << to_string(result.method);
    if (result.method != MethodName::kRoads) continue;
    EXPECT_GE(outcome.answer.mode.value().ellipse.sigma_m[1], 250.0 * kToldAttitudeSigma.radians())
        << "how well the attitude is known is part of the accuracy";
  }
}

TEST_F(BenchRunOfACamera, PlacesTheUavByItsHeightAboveTheSeaWhereTheMapKnowsThatOfItsGround) {
  constexpr const char* kQueries = R"({"map": "town", "frames": "oblique.csv"})";
  describe_frame("agl_m", 250.0);
  const double rho = run(kQueries, R"("roads")").at(0).outcomes.at(0).answer.rho_at_truth.value();
  write_elevation_model("dem.asc");
  const Terrain terrain = slope();
  take_frame(Relief(terrain, truth, 250.0));
  describe_frame("alt_m", height_m(truth.position) + 250.0);
  for (const char* prior : {R"("map")", R"({"radius_m": 200})"}) {
    const auto results = run(std::string(R"({"map": "town", "frames": "oblique.csv", "prior": )") + prior + "}",
                             R"("roads")", R"("dem.asc")");
    const Outcome& outcome = results.at(0).outcomes.at(0);
    EXPECT_LT(outcome.error_m.value(), 5.0) << prior;
    EXPECT_NEAR(outcome.answer.mode.value().agl_m.value(), 250.0, 3.0) << prior;
    EXPECT_NEAR(outcome.answer.rho_at_truth.value(), rho, 0.03) << prior;
  }
}

TEST_F(BenchRunOfACamera, LaysFramesTogetherThatWereTakenFromSeveralHeightsOverASlope) {
  constexpr const char* kQueries = R"({"map": "town", "frames": "oblique.csv", "together": 2})";
  const GridPose before = moved(truth, {-70.0, 30.0, Angle::degrees(20.0)});
  const double higher_m = 150.0;
  const double above_sea_m = height_m(truth.position) + 250.0;
  const double agl_before_m = above_sea_m + higher_m - height_m(before.position);
  take_frame("before.png", before, agl_before_m, {});
  describe_frames("agl_m", {{"before.png", before, agl_before_m}, {"oblique.png", truth, 250.0}});
  const double rho = run(kQueries, R"("roads")").at(0).outcomes.at(1).answer.rho_at_truth.value();

  write_elevation_model("dem.asc");
  const Terrain terrain = slope();
  take_frame("before.png", before, agl_before_m, Relief(terrain, before, agl_before_m));
  take_frame(Relief(terrain, truth, 250.0));
  const auto expect_found = [&] {
    const auto results = run(kQueries, R"("roads")", R"("dem.asc")");
    const Outcome& outcome = results.at(0).outcomes.at(1);
    EXPECT_LT(outcome.error_m.value(), 5.0);
    EXPECT_NEAR(outcome.answer.rho_at_truth.value(), rho, 0.04);
  };
  expect_found();
  describe_frames("alt_m", {{"before.png", before, above_sea_m + higher_m}, {"oblique.png", truth, above_sea_m}});
  expect_found();
}

TEST_F(BenchRunOfACamera, LeavesOutFramesWhoseHeightAboveTheSeaTellsNothing) {
  std::vector<std::string> left_out;
  options.left_out = [&](const std::string& why) { left_out.push_back(why); };
  const auto why_left_out = [&](double alt_m, const std::string& terrain) {
    describe_frame("alt_m", alt_m);
    left_out.clear();
    EXPECT_TRUE(run(R"({"map": "town", "frames": "oblique.csv"})", R"("roads")", terrain).empty());
    return left_out;
  };
  write_elevation_model("dem.asc");
  EXPECT_THAT(why_left_out(397.0, ""),
              ElementsAre(AllOf(HasSubstr("oblique.png has alt_m, and the map 'town' does not know how high"),
                                HasSubstr("[terrain-missing]"))));
  EXPECT_THAT(why_left_out(20.0, R"("dem.asc")"),
              ElementsAre(AllOf(HasSubstr("oblique.png: at 20 m above the sea"), HasSubstr("[below-ground]"))));
  const LatLon at = UtmZone::from_epsg(32634).value().unproject(truth.position);
  std::ofstream mixed(folder / "mixed.csv");
  mixed << std::setprecision(10) << "file,lat,lon,heading_deg,agl_m,alt_m,fov_deg\n";
  for (const char* heights : {",397", "250,"}) {
    mixed << "oblique.png," << at.lat_deg << ',' << at.lon_deg << ",0," << heights << ",60\n";
  }
  mixed.close();
  left_out.clear();
  EXPECT_TRUE(run(R"({"map": "town", "frames": "mixed.csv", "together": 2})", R"("roads")", R"("dem.asc")").empty());
  EXPECT_THAT(left_out, ElementsAre(HasSubstr("[frames-without-size]")));
}

TEST_F(BenchRunOfFrames, CountsAFrameBeyondTheMapAsNotFoundWhateverIsToldOfItsPlace) {
  std::ofstream(folder / "frames.csv", std::ios::app) << "frame.png,36.3,19.89,0,1\n";
  for (const char* prior : {R"("map")", R"({"radius_m": 200})"}) {
    const auto results =
        run(std::string(R"({"map": "town", "frames": "frames.csv", "prior": )") + prior + "}", R"("roads", "sift")");
    for (const SetResult& result : results) {
      EXPECT_EQ(summary_of(result.outcomes).n, 2) << to_string(result.method) << prior;
      EXPECT_EQ(summary_of(result.outcomes).recall_5, 0.5) << to_string(result.method) << prior;
    }
    if (results.at(0).query_set == "frames.csv") continue;
    EXPECT_EQ(results[0].outcomes.at(1).answer.reason, "prior-outside-map");
  }
}

TEST_F(BenchRunOfFrames, LeavesOutFramesThatCannotBeReadAndAsksTheOthers) {
  take_flight(folder.path());
  std::filesystem::resize_file(folder / "flight1.png", 2000);
  std::ofstream(folder / "flight.csv", std::ios::app) << "a,lost.png,36.13,19.89,0,1\n";
  std::vector<std::string> left_out;
  options.left_out = [&](const std::string& why) { left_out.push_back(why); };
  const auto results = run(R"({"map": "town", "frames": "flight.csv", "together": 2})", R"("roads")");
  EXPECT_THAT(left_out, ElementsAre(AllOf(HasSubstr("flight1.png: "), HasSubstr("[image-damaged]")),
                                    AllOf(HasSubstr("lost.png"), HasSubstr("[file-not-found]"))));
  ASSERT_EQ(results.at(0).outcomes.size(), 2U);
  const Outcome& after = results[0].outcomes[1];
  EXPECT_EQ(after.id, "flight2.png");
  EXPECT_LT(after.error_m.value(), 3.0) << "laid together with the frame before the damaged one";
  EXPECT_GE(after.answer.mode.value().ellipse.sigma_m[1], 70.0 * kToldOffsetShare);
}

TEST_F(BenchRunOfFrames, NamesTheFrameWhoseCameraCannotBe) {
  std::ofstream(folder / "level.csv") << "file,lat,lon,heading_deg,agl_m,fov_deg,pitch_deg\n"
                                         "frame.png,36.13,19.89,0,250,60,89\n";
  std::vector<std::string> left_out;
  options.left_out = [&](const std::string& why) { left_out.push_back(why); };
  EXPECT_TRUE(run(R"({"map": "town", "frames": "level.csv", "elsewhere": true})", R"("roads")").empty());
  EXPECT_THAT(left_out, ElementsAre(HasSubstr("frame.png: ")));
}

}  // namespace
}  // namespace roadfix::bench
