// Where, when and with which camera a drone took a picture, as its file says: EXIF, and the XMP of DJI and Autel
// (GimbalPitchDegree, RelativeAltitude, DewarpData, by DJI's lists of photo data fields), Parrot (CameraPitchDegree, by
// its table of photo metadata) or Pix4D (Camera:Pitch, Camera:AboveGroundAltitude), which Parrot, senseFly and others
// write.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/detect/frame_camera.hpp"
#include "core/geodesy/utm.hpp"
#include "tiles/imagery/picture_tags.hpp"

namespace roadfix {

/// Why the focal length that a file tells cannot be used.
struct LensDoubt {
  const char* code;
  std::string what;  ///< after "the picture's file"
};

/// What the tags say; nothing where they do not.
struct DronePicture {
  std::optional<LatLon> place;      ///< not of degrees without minutes and seconds, of which GDAL tells six digits
  std::optional<double> time_s;     ///< since 1970 by the camera's clock, whose time zone no tag says
  std::optional<double> agl_m;      ///< height above ground
  std::optional<double> takeoff_m;  ///< height above the place of the take-off
  std::optional<Angle> heading;     ///< of the frame's upper edge
  std::optional<Angle> roll;        ///< with `heading`, as FrameCamera has them: 0 = straight down
  std::optional<Angle> pitch;       ///< likewise
  std::optional<double> focal_px;   ///< of the picture as it is, also where it was made smaller; none with a doubt
  std::optional<cv::Point2d> principal_px;
  std::vector<double> distortion;  ///< by OpenCV's model; empty where the picture has none any more, or none is told
  std::optional<LensDoubt> doubt;
};

DronePicture drone_picture(const PictureTags& tags);

/// What somebody knows better than the picture's file.
struct KnownView {
  std::optional<double> agl_m;
  std::optional<Angle> roll;
  std::optional<Angle> pitch;
  /// How much higher the place of the take-off lies than the ground below; of use without `agl_m`.
  std::optional<double> takeoff_agl_m = {};
  std::optional<Angle> attitude_sigma = {};  ///< FrameCamera::attitude_sigma
};

/// Height above the place of the take-off. Throws InvalidInput "camera-not-in-file" where none is told.
double required_takeoff_m(const DronePicture& picture);

/// The camera that took it, with its roll and pitch. Where only the height above the take-off is told, the ground below
/// is taken to be as high as that place, unless it is known how much lower. Throws InvalidInput "camera-not-in-file"
/// that says what is missing, "camera-contradictory" where the file tells two focal lengths that differ, and
/// "camera-zoomed" where the camera enlarged what it saw.
FrameCamera camera_of(const DronePicture& picture, const KnownView& known);

}  // namespace roadfix
