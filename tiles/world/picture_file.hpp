// Writes a picture tile by tile as a georeferenced GeoTIFF: compressed, tiled, three bands of 8 bits.
#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "core/units/file_beside.hpp"
#include "tiles/sources/gdal_session.hpp"
#include "tiles/world/settings.hpp"

namespace roadfix::world {

/// The file appears under its name when finish() returns; without it nothing is left behind.
class PictureFile {
 public:
  /// Throws IoFailure "result-unwritable", as the others do.
  PictureFile(const std::string& path, const Placement& placement);

  /// Red, green, blue; `corner` is the tile's place in the picture.
  void write(cv::Point corner, const cv::Mat3b& pixels);
  void finish();

 private:
  FileBeside file_;
  DatasetPtr dataset_;  ///< closed before the file is removed
};

}  // namespace roadfix::world
