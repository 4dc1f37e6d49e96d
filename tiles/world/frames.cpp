#include "tiles/world/frames.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "core/detect/orthoimage.hpp"
#include "core/units/error.hpp"
#include "tiles/sources/gdal_session.hpp"
#include "tiles/world/world_files.hpp"

namespace roadfix::world {
namespace {

cv::Mat3b read_pixels(const std::string& picture, cv::Rect pixels) {
  const DatasetPtr dataset = open_dataset(picture, GDAL_OF_RASTER);
  const GdalMessages messages;
  cv::Mat3b result(pixels.size());
  if (dataset->RasterIO(GF_Read, pixels.x, pixels.y, pixels.width, pixels.height, result.data, pixels.width,
                        pixels.height, GDT_Byte, 3, nullptr, 3, static_cast<GSpacing>(result.step[0]), 1,
                        nullptr) != CE_None) {
    throw IoFailure("world-unreadable", fmt::format("{}: cannot be read again ({})", picture, messages.text()));
  }
  return result;
}

}  // namespace

std::vector<GridPose> draw_poses(const WorldSettings& settings, const Placement& placement, Random& random) {
  std::vector<GridPose> poses;
  for (int i = 0; i < settings.frames; ++i) {
    const Angle heading = Angle::radians(random.uniform(0.0, 2.0 * std::numbers::pi));
    const double half =
        settings.footprint_m / 2.0 * (std::abs(cos(heading)) + std::abs(sin(heading))) / placement.gsd_m + 1.0;
    const double col = random.uniform(half, placement.cols - half);
    const double row = random.uniform(half, placement.rows - half);
    poses.push_back({placement.point_of(col, row), heading});
  }
  return poses;
}

cv::Mat3b cut_frame(const std::string& picture, const Placement& placement, const GridPose& pose, double footprint_m) {
  const int side = static_cast<int>(std::lround(footprint_m / placement.gsd_m));
  const double col = (pose.position.east_m - placement.north_west.east_m) / placement.gsd_m;
  const double row = (placement.north_west.north_m - pose.position.north_m) / placement.gsd_m;
  const int reach = static_cast<int>(std::ceil(side * std::numbers::sqrt2 / 2.0)) + 2;
  const cv::Rect around(static_cast<int>(col) - reach, static_cast<int>(row) - reach, 2 * reach, 2 * reach);
  const cv::Rect pixels = around & cv::Rect(0, 0, placement.cols, placement.rows);
  const GridPoint north_west = placement.point_of(pixels.x, pixels.y);
  const cv::Mat observed(pixels.size(), CV_8UC1, cv::Scalar(255));
  return cut_out({{read_pixels(picture, pixels), observed, placement.gsd_m}, north_west}, pose,
                 {footprint_m, footprint_m}, placement.gsd_m)
      .pixels;
}

void write_frames(const std::string& picture, const std::string& folder, const WorldSettings& settings,
                  const Placement& placement, const std::vector<GridPose>& poses, const std::stop_token& stop) {
  std::ofstream table(folder + "/frames.csv");
  table << "file,lat,lon,heading_deg,gsd_m\n";
  for (std::size_t i = 0; i < poses.size(); ++i) {
    throw_if_stopped(stop);
    const std::string name = fmt::format("frame_{:02}.png", i + 1);
    cv::Mat bgr;
    cv::cvtColor(cut_frame(picture, placement, poses[i], settings.footprint_m), bgr, cv::COLOR_RGB2BGR);
    if (!cv::imwrite(folder + "/" + name, bgr)) {
      throw IoFailure("result-unwritable", fmt::format("{}/{}: cannot be written", folder, name));
    }
    const LatLon at = placement.zone.unproject(poses[i].position);
    const Angle heading = placement.zone.true_from_grid(poses[i].heading, poses[i].position);
    table << fmt::format("{},{:.8f},{:.8f},{:.4f},{:g}\n", name, at.lat_deg, at.lon_deg, heading.compass_degrees(),
                         placement.gsd_m);
  }
  if (!table.flush()) throw IoFailure("result-unwritable", fmt::format("{}/frames.csv: cannot be written", folder));
}

}  // namespace roadfix::world
