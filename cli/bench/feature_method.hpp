// The usual way, for comparison: SIFT or ORB keypoints of the frame against those of the map's own imagery,
// a similarity by RANSAC. The scale is known, so only similarities near it count.
#pragma once

#include <memory>
#include <vector>

#include "cli/bench/query.hpp"
#include "core/geodesy/utm.hpp"

namespace roadfix::bench {

enum class FeatureKind { kSift, kOrb };

/// `imagery`: the pre-disaster imagery of the map's sources on the plane of `zone`.
/// Status is `fix` with 15 inliers or more; the pose of the best similarity is given in any case.
std::unique_ptr<Method> make_feature_method(FeatureKind kind, const std::vector<Orthoimage>& imagery,
                                            const UtmZone& zone);

}  // namespace roadfix::bench
