// Where the pixels of a raster lie on the plane of the map's zone: geotransform (rotated ones too), ground control
// points or RPC (at the mean height of the scene), and the change of reference system.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/geodesy/utm.hpp"
#include "core/units/planar.hpp"
#include "tiles/imagery/raster_file.hpp"

namespace roadfix {

struct DestroyTransformer {
  void operator()(void* transformer) const;
};
/// Of GDALCreateGenImgProjTransformer2().
using PixelTransformerPtr = std::unique_ptr<void, DestroyTransformer>;

class Georeference {
 public:
  /// Refers to the file, which must outlive it. Throws InvalidInput ("crs-not-transformable", "datum-unknown",
  /// "image-without-georeference" where its geotransform gives pixels no area, "degrees-as-metres", "axes-swapped").
  Georeference(const RasterFile& file, UtmZone zone);

  /// Pixel coordinates of points on the plane; NaN where a point has no place in the image's reference system.
  void to_pixels(std::vector<cv::Point2d>& points) const;
  void to_plane(std::vector<cv::Point2d>& points) const;

  /// Bounding box of the image. Throws InvalidInput "crs-not-transformable" when it has no place in the zone,
  /// "raster-beyond-its-reference" when a part of it could be placed there, but not found again.
  GridBox footprint() const;
  /// Boxes around the file's parts: what lies within the footprint, but in none of them, holds nothing.
  std::vector<GridBox> boxes_of_parts() const;
  /// Size of the ground that a pixel covers at the centre: the root of its area.
  double gsd_m() const;

 private:
  const RasterFile* file_;
  UtmZone zone_;
  PixelTransformerPtr transformer_;
};

/// Geographic centre of the image, to choose a zone by. Throws as a Georeference does.
LatLon centre_of(const RasterFile& file);

}  // namespace roadfix
