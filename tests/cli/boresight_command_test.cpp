// roadfix boresight as a person meets it: a flight with GPS over a rendered town after its earthquake, whose camera is
// mounted askew.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <random>
#include <string>
#include <vector>

#include "core/detect/attitude.hpp"
#include "core/geodesy/geo_pose.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/taken_over.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tiles/imagery/read_orthoimage.hpp"

namespace roadfix {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::ProgramResult;

/// One town for all tests of a process, since it takes longer than they do.
class BoresightCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = new testing::TemporaryFolder;
    ASSERT_EQ(roadfix("world " + path("town") + " --seed 5 --size-km 1.2x1.2 --frames 0").code, 0);
    ASSERT_EQ(roadfix("ingest " + path("town/pre.tif") + " --map " + path("town.gpkg")).code, 0);
    take_flight();
  }
  static void TearDownTestSuite() { delete folder; }

  static std::string path(const std::string& name) { return (*folder / name).string(); }
  static ProgramResult roadfix(const std::string& arguments) { return testing::run_program(folder->path(), arguments); }

  /// From 300 m, 360 x 270 m each; the airframe leans by some degrees, and its camera in it.
  static void take_flight() {
    const std::string post = path("town/post.tif");
    const UtmZone zone = zone_of_image(post);
    const Orthoimage ground = read_orthoimage(post, zone);
    const GridPoint middle = ground.box().centre();
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> share(-1.0, 1.0);
    std::string table = std::string(kColumns);
    for (int i = 0; i < kFrames; ++i) {
      const GridPose place{{middle.east_m + 250.0 * share(random), middle.north_m + 250.0 * share(random)}, {}};
      const Attitude body{Angle::degrees(180.0 * share(random)), Angle::degrees(4.0 * share(random)),
                          Angle::degrees(4.0 * share(random))};
      const Attitude actual = mounted(body, kMount);
      FrameCamera camera;
      camera.focal_px = 500.0;
      camera.agl_m = 300.0;
      camera.pitch = actual.pitch;
      camera.roll = actual.roll;
      const std::string name = fmt::format("frame{}.jpg", i);
      cv::imwrite(path(name), testing::taken_over(ground, {place.position, actual.yaw}, camera, {600, 450}));
      const GeoPose told = on_earth({place.position, body.yaw}, zone);
      table += fmt::format("{},{:.8f},{:.8f},{:.4f},300,500,{:.4f},{:.4f}\n", name, told.position.lat_deg,
                           told.position.lon_deg, told.heading.degrees(), body.roll.degrees(), body.pitch.degrees());
    }
    std::ofstream(path("frames.csv")) << table;
  }
  static std::string table_of(const std::string& name, const std::string& columns, const std::string& rows) {
    std::ofstream(path(name)) << columns << rows;
    return path(name);
  }

  static constexpr int kFrames = 9;
  static constexpr const char* kColumns = "file,lat,lon,heading_deg,agl_m,focal_px,roll_deg,pitch_deg\n";
  static constexpr Attitude kMount{Angle::degrees(4.0), Angle::degrees(3.0), Angle::degrees(-2.0)};
  static inline testing::TemporaryFolder* folder = nullptr;
};

TEST_F(BoresightCommand, SaysHowTheCameraIsMountedBesideWhatCountedAlready) {
  const ProgramResult result =
      roadfix("boresight " + path("town.gpkg") + " " + path("frames.csv") + " --mounted 90,0,0 --json");
  ASSERT_EQ(result.code, 0) << result.err;
  const nlohmann::json found = nlohmann::json::parse(result.out);
  for (const auto& [angle, degrees] : {std::pair{"yaw_deg", 4.0}, {"pitch_deg", 3.0}, {"roll_deg", -2.0}}) {
    const double sigma = found[angle]["sigma"].get<double>();
    EXPECT_LT(sigma, 0.5) << angle;
    EXPECT_NEAR(found[angle]["value"].get<double>(), degrees, 4.0 * sigma) << angle;
  }
  EXPECT_NEAR(found["mount"]["yaw_deg"].get<double>(), 90.0 + found["yaw_deg"]["value"].get<double>(), 1e-6);
  EXPECT_NEAR(found["size"]["value"].get<double>(), 1.0, 0.02);
  EXPECT_GT(found["told_rms_m"], 15.0);
  EXPECT_LT(found["corrected_rms_m"], 4.0);
  EXPECT_FALSE(found["roll_reversed"].get<bool>() || found["pitch_reversed"].get<bool>());
  EXPECT_FALSE(found.contains("delay_s")) << "its table has no times";
  EXPECT_EQ(found["map"]["name"], "town");
  ASSERT_EQ(found["frames"].size(), static_cast<std::size_t>(kFrames));
  EXPECT_EQ(found["frames"][0]["file"], "frame0.jpg");
}

TEST_F(BoresightCommand, GoesOnWithoutFramesThatAreMissingOrBeyondTheMap) {
  std::string rows = testing::text_of(path("frames.csv"));
  rows.replace(rows.find("frame1.jpg"), 10, "absent.jpg");
  const std::string table = table_of("some.csv", "", rows + "beyond.jpg,37.9,38.3,0,300,500,0,0\n");
  const ProgramResult result = roadfix("boresight " + path("town.gpkg") + " " + table);
  EXPECT_EQ(result.code, 1) << "for the one that is missing";
  EXPECT_THAT(result.out, AllOf(HasSubstr(" of 10 frames found"), HasSubstr("\n  pitch "), HasSubstr("--camera-yaw ")));
  EXPECT_THAT(result.err, AllOf(HasSubstr("locating 100.0 %"), HasSubstr("absent.jpg"),
                                HasSubstr("[pictures-left-out]"), Not(HasSubstr("beyond.jpg"))));
}

TEST_F(BoresightCommand, RefusesAFlightOfWhichTooLittleIsFoundAndFramesOfNoCamera) {
  const std::string rows = testing::text_of(path("frames.csv"));
  const std::string few = table_of("few.csv", "", rows.substr(0, rows.find("frame3.jpg")));
  const ProgramResult result = roadfix("boresight " + path("town.gpkg") + " " + few);
  EXPECT_EQ(result.code, 1);
  EXPECT_THAT(result.err, AllOf(HasSubstr("of 3 frames were found"), HasSubstr("[boresight-too-few]")));
  const std::string table =
      table_of("rectified.csv", "file,lat,lon,heading_deg,gsd_m\n", "frame0.jpg,37.76,38.27,0,0.6\n");
  EXPECT_THAT(roadfix("boresight " + path("town.gpkg") + " " + table).err, HasSubstr("[boresight-no-camera]"));
  EXPECT_EQ(roadfix("boresight " + path("town.gpkg") + " " + few + " --mounted nan,0,0").code, 2);
}

}  // namespace
}  // namespace roadfix
