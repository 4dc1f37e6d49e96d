// What imagery says, or does not say, about the meaning of its bands.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "tiles/imagery/raster_file.hpp"

namespace roadfix {

/// Whether it has one band of real numbers.
bool looks_like_heights(const RasterFile& file);

/// Of files that are given as imagery: that they look like roads or heights; more than three bands without colours, or
/// bands that have some of the three; an alpha band that looks like something else, as near infrared written without
/// saying so does.
class BandNotes {
 public:
  void add(RasterFile& file);
  /// One of each kind: that of the first file which gives it, and how many others there are.
  std::vector<std::string> texts() const;

 private:
  struct Kind {
    std::string first;
    int others = 0;
    std::string next;  ///< path of the second file
  };
  std::array<Kind, 3> kinds_;
};

}  // namespace roadfix
