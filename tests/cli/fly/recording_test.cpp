#include "cli/fly/recording.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <variant>

#include "tests/support/code_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roadfix::fly {
namespace {

using testing::code_of;

/// Every cell of a picture has its brightness.
class Brightness : public RoadDetector {
 public:
  CellArray detect(const GroundImage& image, double cell_m, std::uint64_t, const std::stop_token&) const override {
    const auto cells = [&](int pixels) { return static_cast<int>(std::ceil(pixels * image.gsd_m / cell_m)); };
    return {cells(image.pixels.cols), cells(image.pixels.rows), image.pixels.at<cv::Vec3b>(0, 0)[0]};
  }
  double preferred_gsd_m() const override { return 1.0; }
  double halo_m() const override { return 0.0; }
  std::string name() const override { return "brightness"; }
  std::string settings() const override { return {}; }
};

class Recordings : public ::testing::Test {
 protected:
  Recordings() {
    for (const int brightness : {10, 20, 30, 40}) {
      cv::imwrite((folder / (std::to_string(brightness) + ".png")).string(),
                  cv::Mat(30, 20, CV_8UC3, cv::Scalar::all(brightness)));
    }
    options.detector = &detector;
  }

  std::vector<Recording> recorded(const std::string& lines) const {
    std::ofstream(folder / "frames.csv") << "file,lat,lon,heading_deg,gsd_m,sequence,time_s\n" << lines;
    return read_recordings(folder / "frames.csv", zone, options);
  }
  Flight replayed(const Recording& recording, std::uint64_t seed = 1) const {
    return replay(recording, plan, seed, [] {});
  }

  const testing::TemporaryFolder folder;
  const UtmZone zone = UtmZone::from_epsg(32634).value();
  const Brightness detector;
  RecordingOptions options;
  FlightPlan plan;
};

constexpr const char* kTwoFlights =
    "10.png,57.50,21.000,0,2,a,100\n"
    "20.png,57.51,21.000,90,2,b,7\n"
    "30.png,57.501,21.000,90,2,a,103.5\n"
    "40.png,57.501,21.002,180,2,a,\n";

TEST_F(Recordings, AreOneFlightForEachSequenceInTheOrderOfTheirFrames) {
  const auto recordings = recorded(kTwoFlights);
  ASSERT_EQ(recordings.size(), 2u);
  EXPECT_EQ(recordings[0].sequence, "a");
  ASSERT_EQ(recordings[0].frames.size(), 3u);
  EXPECT_EQ(recordings[1].frames.size(), 1u);
  const RecordedFrame& first = recordings[0].frames[0];
  EXPECT_EQ(first.footprint.width_m, 40.0);
  EXPECT_EQ(first.footprint.height_m, 60.0);
  EXPECT_EQ(first.observation.features->cells, CellArray(20, 30, 10));
  EXPECT_EQ(recordings[0].frames[1].observation.features->cells.at(0, 0), 30);
  options.max_frames = 2;
  EXPECT_EQ(recorded(kTwoFlights)[0].frames.size(), 2u);
}

TEST_F(Recordings, AreReplayedAtTheirTimesAndOdometryWithoutErrorsLeadsFromPoseToPose) {
  plan.odometry = {0.0, Angle(), 0.0, Angle()};
  const Flight flight = replayed(recorded(kTwoFlights)[0]);
  ASSERT_EQ(flight.size(), 3u);
  EXPECT_EQ(flight[1].input.time_us - flight[0].input.time_us, 3'500'000);
  EXPECT_EQ(flight[2].input.time_us - flight[1].input.time_us, 1'000'000) << "no time is known: a step";
  EXPECT_FALSE(flight[0].input.odometry);
  // One thousandth of a degree of latitude at 57.5 degrees is 111.36 m on the ellipsoid, 2 of longitude 119.95 m.
  const Odometry north = flight[1].input.odometry.value();
  EXPECT_NEAR(north.forward_m, 111.36, 0.1);
  EXPECT_NEAR(north.right_m, 0.0, 0.01);
  EXPECT_NEAR(north.turn.degrees(), 90.0, 0.01);
  const Odometry east = flight[2].input.odometry.value();
  EXPECT_NEAR(east.forward_m, 119.95, 0.15);
  EXPECT_NEAR(east.right_m, 0.0, 0.01);
  EXPECT_EQ(flight[2].input.features->cells.at(0, 0), 40);
}

TEST_F(Recordings, HaveOdometryThatDoesNotFeelTheWind) {
  const Recording recording = recorded(kTwoFlights)[0];
  plan.odometry = {0.0, Angle(), 0.0, Angle(), 5.0};
  const Flight flight = replayed(recording);
  const auto blown_m_s = [&](std::size_t i) {
    const GridPoint there = moved(flight[i - 1].truth, *flight[i].input.odometry).position;
    const GridPoint at = flight[i].truth.position;
    const double seconds = 1e-6 * static_cast<double>(flight[i].input.time_us - flight[i - 1].input.time_us);
    return GridPoint{(at.east_m - there.east_m) / seconds, (at.north_m - there.north_m) / seconds};
  };
  EXPECT_GT(distance_m(blown_m_s(1), {}), 0.1);
  EXPECT_LT(distance_m(blown_m_s(1), blown_m_s(2)), 1e-6);
}

TEST_F(Recordings, HaveOdometryErrorsAndLostFramesByTheSeedAndThePlan) {
  const Recording recording = recorded(kTwoFlights)[0];
  const auto forward = [&](std::uint64_t seed) { return replayed(recording, seed)[1].input.odometry->forward_m; };
  EXPECT_EQ(forward(1), forward(1));
  EXPECT_NE(forward(1), forward(2));
  plan.outage = IndexRange{1, 2};
  const Flight flight = replayed(recording);
  EXPECT_TRUE(flight[0].input.saw());
  EXPECT_FALSE(flight[1].input.saw());
  EXPECT_TRUE(flight[1].input.odometry);
  EXPECT_TRUE(flight[2].input.saw());
}

TEST_F(Recordings, KeepTheirPicturesForADetectorElsewhere) {
  options.detector = nullptr;
  const Flight flight = replayed(recorded(kTwoFlights)[0]);
  EXPECT_FALSE(flight[1].input.features);
  EXPECT_EQ(flight[1].input.frame().picture.pixels.at<cv::Vec3b>(3, 4)[1], 30);
}

TEST_F(Recordings, OfACameraShowTheGroundThatItSaw) {
  std::ofstream(folder / "camera.csv") << "file,lat,lon,heading_deg,agl_m,focal_px,roll_deg,pitch_deg\n"
                                          "10.png,57.5,21,0,100,50,0,30\n";
  const auto read = [&] { return read_recordings(folder / "camera.csv", zone, options).at(0).frames.at(0); };
  const RecordedFrame seen = read();
  EXPECT_EQ(seen.footprint.width_m, 20 * 100.0 / 50.0);
  EXPECT_EQ(seen.footprint.height_m, 30 * 100.0 / 50.0);
  const FeatureMap& features = seen.observation.features.value();
  EXPECT_GT(features.nadir_sigma_m, 100.0 * kToldAttitudeSigma.radians());
  EXPECT_LT(features.nadir_sigma_m, 100.0 * kUntoldAttitudeSigma.radians());
  const double ahead_m = (features.nadir.row - features.cells.rows() / 2.0) * features.cell_m;
  EXPECT_GT(ahead_m, 100.0 * std::tan(Angle::degrees(30).radians())) << "the nose is up, so it looks ahead";

  options.detector = nullptr;
  const CameraFrame sent = read().observation.frame();
  EXPECT_EQ(sent.picture.pixels.size(), cv::Size(20, 30)) << "as it was taken";
  EXPECT_EQ(std::get<FrameCamera>(sent.view).pitch, Angle::degrees(30));
}

TEST_F(Recordings, TellTheFiltersFromWhereACameraSawWhatItShows) {
  std::ofstream(folder / "heights.csv") << "file,lat,lon,heading_deg,agl_m,alt_m,gsd_m,focal_px,roll_deg,pitch_deg\n"
                                           "10.png,57.5,21,0,100,,,50,0,0\n"
                                           "20.png,57.5,21,0,,900,,50,0,0\n"
                                           "30.png,57.5,21,0,,,2\n";
  const GridPoint below = zone.project({57.5, 21.0});
  options.agl_m = [&](GridPoint point, double above_sea_m) {
    EXPECT_LT(distance_m(point, below), 1e-6);
    return above_sea_m - 700.0;
  };
  const Recording recording = read_recordings(folder / "heights.csv", zone, options).at(0);
  EXPECT_EQ(recording.frames[1].footprint.width_m, 20 * 200.0 / 50.0);
  EXPECT_EQ(recording.frames[1].observation.features->cells.cols(),
            2 * recording.frames[0].observation.features->cells.cols());
  const Flight flight = replayed(recording);
  EXPECT_FALSE(flight[0].input.altitude.value().above_sea_m);
  EXPECT_EQ(flight[0].input.altitude->agl_m, 100.0);
  EXPECT_EQ(flight[1].input.altitude.value().above_sea_m, 900.0);
  EXPECT_EQ(flight[1].input.altitude->agl_m, 200.0);
  EXPECT_FALSE(flight[2].input.altitude);
}

TEST_F(Recordings, KeepTheTimesThatAreToldBesideFramesWithoutOne) {
  const Flight flight =
      replayed(recorded("10.png,57.5,21,0,2,a,100\n20.png,57.5,21,0,2,a,\n30.png,57.5,21,0,2,a,110\n").at(0));
  EXPECT_EQ(flight[1].input.time_us - flight[0].input.time_us, 1'000'000);
  EXPECT_EQ(flight[2].input.time_us - flight[0].input.time_us, 10'000'000);
}

TEST_F(Recordings, AreRefusedBeforeTheirFirstFrameIsRead) {
  int read = 0;
  const auto complaint = [&](const std::string& lines) {
    std::ofstream(folder / "frames.csv") << "file,lat,lon,heading_deg,gsd_m,sequence,time_s\n" << lines;
    return testing::message_of(
        [&] { read_recordings(folder / "frames.csv", zone, options, [&](std::int64_t, std::int64_t) { ++read; }); });
  };
  const std::string whole = "10.png,57.5,21,0,2,a,5\n20.png,57.5,21,0,2,a,6\n";
  EXPECT_THAT(complaint(whole + "none.png,57.5,21,0,2,a,7\n"), ::testing::HasSubstr("none.png"));
  EXPECT_THAT(complaint(whole + "30.png,57.5,21,0,2,b,5\n40.png,57.5,21,0,2,b,5\n"),
              ::testing::HasSubstr("40.png was taken 0.000 s after 30.png"));
  EXPECT_EQ(read, 0);
}

TEST_F(Recordings, ThatCannotBeFlownAreRefused) {
  EXPECT_EQ(code_of([&] { recorded("10.png,57.5,21,0,2,a,5\n20.png,57.5,21,0,2,a,5\n"); }), "recording-time");
  EXPECT_EQ(code_of([&] { recorded("none.png,57.5,21,0,2,a,5\n"); }), "file-not-found");
  EXPECT_EQ(code_of([&] { read_recordings(folder / "none.csv", zone, options); }), "file-not-found");
}

}  // namespace
}  // namespace roadfix::fly
