#include "core/detect/road_detector.hpp"

#include <fmt/format.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/units/error.hpp"

namespace roadfix {
namespace {

constexpr std::string_view kAfterName = " gsd_m=";

std::string_view name_in(std::string_view description) { return description.substr(0, description.find(kAfterName)); }

}  // namespace

std::string RoadDetector::describe() const {
  return fmt::format("{}{}{} {}", name(), kAfterName, preferred_gsd_m(), settings());
}

bool is_same_reader(std::string_view description, std::string_view other) {
  return name_in(description) == name_in(other);
}

void require_not_interrupted(const std::stop_token& stop) {
  if (!stop.stop_requested()) return;
  throw Interrupted("detection-interrupted",
                    "the time limit ended before all roads of the picture were found: send one that shows less ground, "
                    "or check its metres per pixel");
}

cv::Mat observed_cells(const GroundImage& image, double cell_m) {
  const double step = cell_m / image.gsd_m;
  const cv::Size cells(static_cast<int>(std::ceil(image.observed.cols / step - 1e-9)),
                       static_cast<int>(std::ceil(image.observed.rows / step - 1e-9)));
  // Pad to whole cells first, so that a cell cut by the border counts its missing pixels as not seen.
  const cv::Size padded(static_cast<int>(std::ceil(cells.width * step - 1e-9)),
                        static_cast<int>(std::ceil(cells.height * step - 1e-9)));
  cv::Mat whole;
  cv::copyMakeBorder(image.observed, whole, 0, std::max(0, padded.height - image.observed.rows), 0,
                     std::max(0, padded.width - image.observed.cols), cv::BORDER_CONSTANT, cv::Scalar(0));
  cv::Mat share;
  cv::resize(whole, share, cells, 0, 0, cv::INTER_AREA);
  cv::Mat result;
  cv::threshold(share, result, 127, 255, cv::THRESH_BINARY);
  return result;
}

}  // namespace roadfix
