#include "tiles/world/frames.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "tests/tiles/world/small_world.hpp"

namespace roadfix::world {
namespace {

using roadfix::testing::TemporaryFolder;
using testing::picture;
using testing::small_settings;

struct Truth {
  std::string file;
  LatLon at;
  Angle heading;
  double gsd_m = 0.0;
};

std::vector<Truth> read_truth(const std::filesystem::path& table) {
  std::ifstream lines(table);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "file,lat,lon,heading_deg,gsd_m");
  std::vector<Truth> result;
  while (std::getline(lines, line)) {
    std::istringstream fields(line);
    Truth truth;
    char comma = 0;
    double heading_deg = 0.0;
    std::getline(fields, truth.file, ',');
    fields >> truth.at.lat_deg >> comma >> truth.at.lon_deg >> comma >> heading_deg >> comma >> truth.gsd_m;
    truth.heading = Angle::degrees(heading_deg);
    result.push_back(truth);
  }
  return result;
}

/// Bilinear, at continuous pixel coordinates whose centres lie at halves.
cv::Vec3d sample(const cv::Mat& image, double col, double row) {
  const int c = static_cast<int>(std::floor(col - 0.5));
  const int r = static_cast<int>(std::floor(row - 0.5));
  const double u = col - 0.5 - c;
  const double v = row - 0.5 - r;
  const auto at = [&](int x, int y) { return cv::Vec3d(image.at<cv::Vec3b>(y, x)); };
  return (at(c, r) * (1 - u) + at(c + 1, r) * u) * (1 - v) + (at(c, r + 1) * (1 - u) + at(c + 1, r + 1) * u) * v;
}

TEST(Frames, ShowWhatThePictureShowsAtTheirPoseFromTrueNorth) {
  const TemporaryFolder folder;
  WorldSettings settings = small_settings();
  settings.centre = LatLon{57.70, 11.97};  // grid north is 2.5 degrees off true north there
  const WorldReport report = render_world(settings, folder.path(), {}, {});
  const cv::Mat after = picture(folder / "post.tif");
  const auto truths = read_truth(folder / "frames" / "frames.csv");
  ASSERT_EQ(truths.size(), 3U);
  for (const Truth& truth : truths) {
    EXPECT_EQ(truth.gsd_m, 1.0);
    const cv::Mat frame = picture(folder / "frames" / truth.file);
    ASSERT_EQ(frame.size(), cv::Size(120, 120));
    const GridPoint centre = report.placement.zone.project(truth.at);
    const Angle heading = report.placement.zone.grid_from_true(truth.heading, centre);
    double difference = 0.0;
    int count = 0;
    for (int row = 3; row < 120; row += 13) {
      for (int col = 2; col < 120; col += 11) {
        const double right = col + 0.5 - 60.0;
        const double forward = 60.0 - row - 0.5;
        const double east = centre.east_m + right * cos(heading) + forward * sin(heading);
        const double north = centre.north_m - right * sin(heading) + forward * cos(heading);
        const cv::Vec3d expected =
            sample(after, east - report.placement.north_west.east_m, report.placement.north_west.north_m - north);
        difference += cv::norm(expected - cv::Vec3d(frame.at<cv::Vec3b>(row, col)));
        ++count;
      }
    }
    EXPECT_LT(difference / count, 2.0) << truth.file;
  }
}

TEST(Frames, LieInsideThePictureWhateverTheirHeading) {
  WorldSettings settings = small_settings();
  settings.frames = 500;
  settings.footprint_m = 200.0;
  const Placement placement = place(settings, kDefaultCentre);
  Random random(1, 1);
  const auto poses = draw_poses(settings, placement, random);
  EXPECT_EQ(poses.size(), 500U);
  for (const GridPose& pose : poses) {
    for (const double right : {-100.0, 100.0}) {
      for (const double forward : {-100.0, 100.0}) {
        const double east = pose.position.east_m + right * cos(pose.heading) + forward * sin(pose.heading);
        const double north = pose.position.north_m - right * sin(pose.heading) + forward * cos(pose.heading);
        EXPECT_GT(east, placement.north_west.east_m);
        EXPECT_LT(east, placement.north_west.east_m + 360.0);
        EXPECT_LT(north, placement.north_west.north_m);
        EXPECT_GT(north, placement.north_west.north_m - 300.0);
      }
    }
  }
}

}  // namespace
}  // namespace roadfix::world
