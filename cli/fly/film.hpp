// An animated GIF: plays in every browser and viewer, and its library comes with GDAL anyway. OpenCV's video writer
// would bring FFmpeg and GStreamer for a few seconds of film.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace roadfix::fly {

class Film {
 public:
  /// CV_8UC3, all of one size. Kept with 256 fixed colours, of all frames but the first what changes, compressed.
  void add(const cv::Mat& picture);
  std::size_t size() const { return changes_.size(); }
  /// Frame i of this film beside frame i of the other; both equally long and high.
  void append_right(const Film& other);
  /// The bytes of the file. It repeats for ever.
  std::string gif(int frames_per_second) const;

 private:
  class Player;
  void keep(const cv::Mat& indices);

  std::vector<std::vector<unsigned char>> changes_;  ///< PNG of indices of the palette, exclusive or with those before
  cv::Mat last_;                                     ///< CV_8UC1, the indices of the last frame
};

}  // namespace roadfix::fly
