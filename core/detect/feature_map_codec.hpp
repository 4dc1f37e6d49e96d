// Feature maps as pictures: cells as grey and alpha, and their scale and nadir as text.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/detect/image_codec.hpp"
#include "core/grid/feature_map.hpp"

namespace roadfix {

/// What a feature map says of itself in addition to its cells (see FeatureMap).
struct FeatureMapScale {
  double cell_m = 1.0;
  GridGeometry::CellPosition nadir;
  double nadir_sigma_m = 0.0;
  Angle nadir_heading_sigma{};
  std::string reader{};  ///< RoadDetector::describe() of what found the roads; empty where that is not told
};

struct FeatureMapPicture {
  CellArray cells;
  std::optional<FeatureMapScale> scale;  ///< of one that encode_feature_map() wrote
};

/// Grey k = probability k / 254 (255 counts as 254, so that 0/255 masks work); alpha below one half = unobserved.
/// 16-bit grey is scaled linearly. Throws as decode_image, and InvalidInput: "feature-map-coloured";
/// "feature-map-altered" where the picture has another size than its scale was written for, so that its nadir lies
/// elsewhere.
FeatureMapPicture decode_feature_map(Bytes bytes, std::int64_t max_pixels);

/// Whether the bytes are a PNG that says of itself that it is a feature map.
bool is_feature_map(Bytes bytes);

/// What is known of a feature map beside its picture.
struct ToldScale {
  std::optional<double> cell_m;
  std::optional<double> nadir_col;
  std::optional<double> nadir_row;
};

/// With the scale of the picture or, if it has none, as told, with the nadir in the middle unless told; one of the two
/// must give the cell size. Throws InvalidInput if both give a value and differ: "cell-size-contradictory",
/// "nadir-contradictory".
FeatureMap feature_map_of(FeatureMapPicture picture, const ToldScale& told);

/// A picture of the ground, as decode_image. Throws what that does, and InvalidInput "frame-is-feature-map" for one
/// that says of itself that it shows roads and no ground.
cv::Mat decode_frame(Bytes bytes, std::int64_t max_pixels, const std::stop_token& stop = {});

/// Grey and alpha PNG that decode_feature_map turns back into exactly this. `reader`: of FeatureMapScale. At least one
/// cell; LimitExceeded ("too-many-cells") for more in a row or column than a PNG holds.
std::vector<std::uint8_t> encode_feature_map(const FeatureMap& map, const std::string& reader = {});
/// The cells alone, as other programs write them.
std::vector<std::uint8_t> encode_feature_map(const CellArray& cells);

}  // namespace roadfix
