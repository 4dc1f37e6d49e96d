// Which value of a raster of roads stands for a certain road, where its type does not say it: by the values sampled of
// it.
#pragma once

#include <vector>

#include "tiles/imagery/raster_file.hpp"

namespace roadfix {

/// What the sampled values of an image say of its range.
struct SampledShares {
  float max = 0.0F;
  bool mask = false;  ///< of 0 and the largest value alone
};
SampledShares sampled_shares(const std::vector<float>& values);

/// Looks at all values of an image where those of its samples are small: roads are few, and may all lie between them.
/// Returns whether there are larger ones. Throws what RasterFile::largest_value() throws.
bool look_beyond_samples(RasterFile& file, SampledShares& sampled);

/// Those by which share_range() chooses and are_ones_only() tells, four at most of however many.
std::vector<float> telling_values(const std::vector<float>& values);

/// Of the values of all images of a source; see ValueRule::kShare (mosaic.hpp).
ValueRange share_range(const std::vector<float>& values, bool integers);

/// Whether some are 1, and none lies between 1 and the largest, which is more.
bool are_ones_only(const std::vector<float>& values, float largest);

}  // namespace roadfix
