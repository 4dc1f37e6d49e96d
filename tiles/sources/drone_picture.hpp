// Where, when and with which camera a drone took a picture, as its file says: EXIF, and the XMP of DJI and Autel
// (GimbalPitchDegree, RelativeAltitude, DewarpData, by DJI's lists of photo data fields) or Pix4D (Camera:Pitch,
// Camera:AboveGroundAltitude), which Parrot and others write.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/detect/frame_camera.hpp"
#include "core/geodesy/utm.hpp"

namespace roadfix {

using Tags = std::map<std::string, std::string>;

/// As they stand in the file.
struct PictureTags {
  Tags exif;  ///< by GDAL's names: EXIF_FocalLength
  Tags xmp;   ///< without prefixes: GimbalPitchDegree
  cv::Size size;
};

/// Attributes and elements without children, wherever they stand; none where the text is no XML.
Tags tags_of_xmp(const std::string& text);

/// Throws NotFound ("source-not-found") or InvalidInput ("source-unreadable").
PictureTags read_picture_tags(const std::string& path);

/// What the tags say; nothing where they do not.
struct DronePicture {
  std::optional<LatLon> place;
  std::optional<double> time_s;     ///< since 1970 by the camera's clock, whose time zone no tag says
  std::optional<double> agl_m;      ///< height above ground
  std::optional<double> takeoff_m;  ///< height above the place of the take-off
  std::optional<Angle> heading;     ///< of the frame's upper edge
  std::optional<double> roll_deg;   ///< with `heading`, as FrameCamera has them: 0 = straight down
  std::optional<double> pitch_deg;  ///< likewise
  std::optional<double> focal_px;   ///< of the picture as it is, also where it was made smaller
  std::optional<cv::Point2d> principal_px;
  std::vector<double> distortion;  ///< by OpenCV's model; empty where the picture has none any more, or none is told
};

DronePicture drone_picture(const PictureTags& tags);

}  // namespace roadfix
