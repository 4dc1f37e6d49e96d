// The picture plane of a camera: the pixel of a ray, and the ray of a pixel.
//
// Rays are (x / z, y / z) in the camera's axes (x right, y down the picture, z along the optical axis). Pixels are
// continuous, (0, 0) = outer corner of the picture. Distortion is OpenCV's: the manual of its module calib3d has the
// equations; cv::calibrateCamera, Kalibr and ROS (camera_info) give the coefficients.
#pragma once

#include <limits>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

namespace roadfix {

enum class LensModel {
  kPerspective,  ///< Brown and Conrady: k1, k2, p1, p2, then k3, then k4, k5, k6 (ROS: plumb_bob, rational_polynomial)
  kFisheye,      ///< Kannala and Brandt: k1, k2, k3, k4 (ROS: equidistant)
};

class Lens {
 public:
  /// Throws InvalidInput ("frame-camera") where the model has no such number of coefficients or one is not finite.
  Lens(double focal_px, cv::Point2d principal, LensModel model, std::vector<double> distortion);

  double focal_px() const { return focal_px_; }

  /// Of rays that lie within().
  std::vector<cv::Point2d> pixels_of(const std::vector<cv::Point2d>& rays) const;
  /// Whether the model is valid this far from the optical axis. Farther out it would fold rays back into the picture.
  bool within(cv::Point2d ray) const { return ray.dot(ray) <= widest_ * widest_; }
  /// nullopt if the pixel belongs to no ray that is within().
  std::optional<cv::Point2d> ray_of(cv::Point2d pixel) const;

 private:
  cv::Matx33d intrinsics() const;
  double widest_ray() const;

  double focal_px_;
  cv::Point2d principal_;
  LensModel model_;
  std::vector<double> distortion_;  ///< empty = none
  double widest_ = std::numeric_limits<double>::infinity();
};

}  // namespace roadfix
