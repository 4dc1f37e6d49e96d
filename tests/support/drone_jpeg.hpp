// A JPEG with the XMP of a drone.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

namespace roadfix::testing {

/// XMP stands in a segment APP1 behind the JPEG's first marker (XMP Specification, part 3). `tags` are attributes:
/// "drone-dji:RelativeAltitude=\"+98.30\"".
inline std::vector<std::uint8_t> drone_jpeg(const cv::Mat& picture, const std::string& tags) {
  std::vector<std::uint8_t> jpeg;
  cv::imencode(".jpg", picture, jpeg);
  const std::string xmp = fmt::format(
      "http://ns.adobe.com/xap/1.0/{0}<x:xmpmeta xmlns:x=\"adobe:ns:meta/\"><r:Description xmlns:r=\"r\" "
      "xmlns:drone-dji=\"d\" {1}/></x:xmpmeta>",
      '\0', tags);
  const std::size_t length = xmp.size() + 2;
  std::vector<std::uint8_t> segment{0xff, 0xe1, static_cast<std::uint8_t>(length >> 8),
                                    static_cast<std::uint8_t>(length & 0xff)};
  segment.insert(segment.end(), xmp.begin(), xmp.end());
  jpeg.insert(jpeg.begin() + 2, segment.begin(), segment.end());
  return jpeg;
}

}  // namespace roadfix::testing
