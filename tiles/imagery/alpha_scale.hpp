// How the values of an alpha band count, by what was sampled of them.
#pragma once

#include <gdal.h>

#include <vector>

namespace roadfix {

struct AlphaScale {
  double full = 1.0;    ///< where all is opaque; a pixel is seen from half of it on
  double graded = 0.0;  ///< share of the samples that are neither transparent nor opaque
  /// Whether the values vary as those of a picture do, as near infrared that was marked as alpha: then `full` is so
  /// small that only next to nothing counts as not seen.
  bool varied = false;
};

/// Full is 255 in bytes. In wider types it follows from the largest sample: programs widen pictures without their
/// alpha.
AlphaScale alpha_scale(const std::vector<float>& samples, GDALDataType type);

}  // namespace roadfix
