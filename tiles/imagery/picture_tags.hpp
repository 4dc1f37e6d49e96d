// EXIF and XMP of a picture as texts.
#pragma once

#include <cstdint>
#include <map>
#include <opencv2/core.hpp>
#include <span>
#include <string>

namespace roadfix {

using Tags = std::map<std::string, std::string>;

/// As they stand in the file.
struct PictureTags {
  Tags exif;  ///< by GDAL's names: EXIF_FocalLength
  Tags xmp;   ///< as tags_of_xmp() names them
  cv::Size size;
};

/// The properties of its descriptions, as attributes or elements, without prefixes: GimbalPitchDegree; those of the
/// namespace Camera of Pix4D and senseFly as Camera:Pitch, since others call other angles so. None where the text is no
/// XML.
Tags tags_of_xmp(const std::string& text);

/// Throws NotFound ("file-not-found") or InvalidInput ("source-unreadable").
PictureTags read_picture_tags(const std::string& path);
/// Of a JPEG in memory, as drones write them; no tags and no size where the bytes are none.
PictureTags read_picture_tags(std::span<const std::uint8_t> bytes);

}  // namespace roadfix
