// A bench over a drawn town, and a detector that makes no mistakes in it.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "cli/bench/run.hpp"
#include "tests/support/street_map.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roadfix::bench {

inline constexpr int kCells = 350;
inline constexpr double kGsdM = 1.0;

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
  std::string name() const override { return "brightness"; }
  std::string settings() const override { return {}; }
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
    options.detectors = &detectors;
    options.maps = {
        detector.get(), 2.0, 1, 2, folder.path(), [](const std::string&, std::int64_t, std::int64_t) {}, {}, "1"};
    options.progress = [](const std::string&, std::int64_t, std::int64_t) {};
  }

  /// `terrain`: the map's elevation models.
  std::vector<SetResult> run(const std::string& queries, const std::string& methods,
                             const std::string& terrain = "") const {
    const std::string text = R"({"maps": [{"name": "town", "sources": [{"path": "town.png", "as": "imagery"}])" +
                             (terrain.empty() ? "" : R"(, "terrain": [)" + terrain + "]") + R"(}], "queries": [)" +
                             queries + R"(], "methods": [)" + methods + "]}";
    return bench::run(parse_manifest(text, folder.path()), options);
  }

  /// The ground of the town rises to the east, from 100 to 200 m above the sea.
  static double height_m(GridPoint point) { return 100.0 + (point.east_m - 400'000.0) / 7.0; }
  void write_elevation_model(const std::string& name, double raised_m = 0.0) const {
    constexpr int kSide = 200;
    constexpr double kCellM = 30.0;
    const GridPoint corner{397'000.0, 3'997'000.0};
    std::ofstream model(folder / name);
    model << "ncols " << kSide << "\nnrows " << kSide << "\nxllcorner " << corner.east_m << "\nyllcorner "
          << corner.north_m << "\ncellsize " << kCellM << '\n';
    for (int row = 0; row < kSide; ++row) {
      for (int col = 0; col < kSide; ++col) {
        model << height_m({corner.east_m + (col + 0.5) * kCellM, corner.north_m}) + raised_m << ' ';
      }
      model << '\n';
    }
    std::ofstream((folder / name).replace_extension(".prj"))
        << "Projection UTM\nZone 34\nDatum WGS84\nSpheroid WGS84\nUnits METERS\nZunits METERS\n";
  }

  testing::TemporaryFolder folder;
  std::shared_ptr<const RoadDetector> detector = std::make_shared<BrightnessDetector>();
  Detectors detectors{detector};
  BenchOptions options;
};

}  // namespace roadfix::bench
