// The camera of a frame: which ground a pixel shows.
//
// Body axes: x forward, y right, z down. With roll and pitch of zero the optical axis points straight down and the top
// row of the frame is the forward edge. Pitch turns the nose up, roll the right side down (aerospace convention): a
// positive pitch moves the seen ground forward, a positive roll to the left. The ground is taken as flat.
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <variant>
#include <vector>

#include "core/detect/lens.hpp"
#include "core/units/angle.hpp"

namespace roadfix {

/// Of roll and pitch as a gimbal or an autopilot tells them.
inline constexpr Angle kToldAttitudeSigma = Angle::degrees(1.0);
/// Where nobody tells them, and straight down is assumed: a multirotor without a gimbal leans that far in a breeze.
inline constexpr Angle kUntoldAttitudeSigma = Angle::degrees(5.0);
/// Nobody who means it tells more.
inline constexpr Angle kLargestAttitudeSigma = Angle::degrees(20.0);

/// Above ground, of a frame that shows roads.
inline constexpr double kHighestAglM = 20'000.0;

/// What is known about the camera when the frame was taken.
struct FrameCamera {
  /// Exactly one of the two is given: the field of view across the columns, of a lens without distortion, in (0, 180)
  /// degrees, or the focal length in pixels.
  std::optional<Angle> horizontal_fov;
  std::optional<double> focal_px;
  /// With a focal length: where the optical axis meets the frame, within its middle half, as calibrations give it
  /// ((0, 0) = centre of the first pixel). nullopt = at the frame's centre.
  std::optional<cv::Point2d> principal_px;
  LensModel lens = LensModel::kPerspective;
  std::vector<double> distortion;  ///< with a focal length; coefficients of the model, empty = none
  double agl_m = 0.0;              ///< altitude above ground, in (0, kHighestAglM]
  std::optional<Angle> roll;       ///< nullopt = unknown: taken as zero, with a larger error
  std::optional<Angle> pitch;
  /// Of roll and pitch, 1 sigma each, in (0, kLargestAttitudeSigma]; nullopt = as mostly where they are told, or not.
  std::optional<Angle> attitude_sigma;

  Angle assumed_roll() const { return roll.value_or(Angle()); }
  Angle assumed_pitch() const { return pitch.value_or(Angle()); }
};

/// Of a frame that was rectified already: its pixels are squares on the ground.
struct StraightDown {
  double gsd_m = 1.0;
};

/// How a frame looks at the ground.
using FrameView = std::variant<StraightDown, FrameCamera>;

/// Throws InvalidInput ("frame-camera") that names the field and its range.
void validate(const FrameCamera& camera, cv::Size frame);

/// Throws what the constructor of Lens does; `camera` is validated.
Lens lens_of(const FrameCamera& camera, cv::Size frame);

/// Rotation from camera axes (x right, y back, z down the optical axis) to the level frame (x right, y back, z down).
cv::Matx33d level_from_camera(const FrameCamera& camera);

/// Where on the ground a ray (Lens) ends: metres right and *back* of the nadir point. nullopt at and above the horizon.
std::optional<cv::Point2d> ground_of(const FrameCamera& camera, cv::Point2d ray);

inline constexpr Angle kFlattestView = Angle::degrees(80.0);
/// Whether the optical axis is not farther from straight down than that.
bool looks_down(const FrameCamera& camera);
/// Throws InvalidInput ("frame-sees-no-ground") where it is.
void require_looking_down(const FrameCamera& camera);

/// Ground sample distance straight below the UAV with the camera level. Throws as validate().
double nominal_gsd_m(const FrameView& view, cv::Size frame);

/// Of roll and pitch, 1 sigma each.
Angle attitude_sigma(const FrameCamera& camera);

/// Relative, 1 sigma: barometers drift, and the ground is not as flat as it is told to be.
inline constexpr double kHeightSigma = 0.05;
/// Error of the point below the UAV relative to what the frame shows, 1 sigma per axis in metres: the sigma of roll and
/// pitch times the height, more in oblique views, and the height's relative error times the distance to what is seen.
double nadir_sigma_m(const FrameCamera& camera);

/// A wrong height does not turn roads, but where the scale is off the best pose turns a little: in radians, by this
/// share of the relative error, as measured with frames and with random roads.
inline constexpr double kTurnOfScale = 1.0 / 6.0;
/// How far errors of roll, pitch and height turn the pose at which the frame fits the ground, 1 sigma.
///
/// Small errors a and b of the attitude, across and along the lean, shear the ground as seen. On the optical axis, at
/// an angle t from straight down, that turns a road by an angle that depends on its direction: by 0 to a tan(t), and by
/// up to b tan(t) / 2 to either side. The mean square over all directions is sigma^2 tan^2(t) / 2.
Angle nadir_heading_sigma(const FrameCamera& camera);

}  // namespace roadfix
