// A JPEG with the XMP and EXIF of a drone.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

namespace roadfix::testing {

/// A segment APP1 behind the JPEG's first marker.
inline void insert_app1(std::vector<std::uint8_t>& jpeg, const std::string& bytes) {
  const std::size_t length = bytes.size() + 2;
  std::vector<std::uint8_t> segment{0xff, 0xe1, static_cast<std::uint8_t>(length >> 8),
                                    static_cast<std::uint8_t>(length & 0xff)};
  segment.insert(segment.end(), bytes.begin(), bytes.end());
  jpeg.insert(jpeg.begin() + 2, segment.begin(), segment.end());
}

/// XMP stands in such a segment (XMP Specification, part 3). `tags` are attributes:
/// "drone-dji:RelativeAltitude=\"+98.30\"".
inline std::vector<std::uint8_t> drone_jpeg(const cv::Mat& picture, const std::string& tags) {
  std::vector<std::uint8_t> jpeg;
  cv::imencode(".jpg", picture, jpeg);
  const std::string xmp = fmt::format(
      "http://ns.adobe.com/xap/1.0/{0}<x:xmpmeta xmlns:x=\"adobe:ns:meta/\"><r:Description xmlns:r=\"r\" "
      "xmlns:drone-dji=\"d\" {1}/></x:xmpmeta>",
      '\0', tags);
  insert_app1(jpeg, xmp);
  return jpeg;
}

/// EXIF that tells FocalLengthIn35mmFilm and no more: a TIFF of two directories with one entry each (EXIF 2.3, 4.6).
inline void add_film_focal_length(std::vector<std::uint8_t>& jpeg, std::uint8_t millimetres) {
  std::string exif(
      "Exif\0\0II*\0\x08\0\0\0"
      "\x01\0\x69\x87\x04\0\x01\0\0\0\x1a\0\0\0\0\0\0\0"  // the EXIF directory is at byte 26
      "\x01\0\x05\xa4\x03\0\x01\0\0\0m\0\0\0\0\0\0\0",    // m is the value
      50);
  exif[exif.find('m')] = static_cast<char>(millimetres);
  insert_app1(jpeg, exif);
}

/// EXIF that tells DateTimeOriginal, "2023:02:09 11:05:10", and SubSecTimeOriginal, of three digits at most.
inline void add_time(std::vector<std::uint8_t>& jpeg, const std::string& time, std::string subseconds) {
  std::string exif(
      "Exif\0\0II*\0\x08\0\0\0"
      "\x01\0\x69\x87\x04\0\x01\0\0\0\x1a\0\0\0\0\0\0\0"  // the EXIF directory is at byte 26
      "\x02\0\x03\x90\x02\0\x14\0\0\0\x38\0\0\0"          // the time at byte 56
      "\x91\x92\x02\0\x04\0\0\0",
      54);
  subseconds.resize(4);
  exif += subseconds + std::string(4, '\0') + time + '\0';
  insert_app1(jpeg, exif);
}

}  // namespace roadfix::testing
