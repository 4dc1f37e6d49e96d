// Collars: many orthophotos are padded with white or black up to a rectangle and do not say so.
//
// A pixel belongs to the collar when its colour is the collar's (within a tolerance, for JPEG blurs it) and it is
// connected to the border of the image through such pixels. Connectedness is judged once, on a copy of at most
// 1024 x 1024 samples, so that it depends on no block and a white roof inside the image stays.
#pragma once

#include <opencv2/core.hpp>
#include <optional>

#include "tiles/imagery/raster_file.hpp"

namespace roadfix {

class Collar {
 public:
  /// Reads the whole image once, row by row of samples.
  Collar(RasterFile& file, Rgb colour, const ValueRange& range);

  /// Marks the collar's pixels of a window of the image as not valid.
  void clear(cv::Rect window, RasterPixels& pixels) const;

 private:
  cv::Size image_;
  Rgb colour_;
  cv::Mat connected_;  ///< CV_8UC1: 255 where the collar may reach
};

/// The colour of a collar that nobody declared, by the corners of the image (core/detect/painted_border.hpp).
std::optional<Rgb> find_collar(RasterFile& file, const ValueRange& range);

/// "white", "black" or "R,G,B" with 0..255 each. Throws InvalidInput "colour-unknown".
Rgb parse_colour(const std::string& text);

}  // namespace roadfix
