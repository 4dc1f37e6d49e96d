// Figure 2 of the paper: the ground before, the frame, the roads of both, and where they agree.
#pragma once

#include <opencv2/core.hpp>
#include <span>

#include "cli/bench/query.hpp"
#include "core/locate/map_view.hpp"

namespace roadfix::bench {

/// Both grids in one picture (CV_8UC3, a pixel for a cell): road in both is white, in `before` alone blue, in `after`
/// alone red, the stronger the surer; what one of them did not observe is grey. Sizes must be equal.
cv::Mat agreement(const CellArray& before, const CellArray& after);

/// The map's cells under a feature map whose nadir is at the pose, in its body frame.
CellArray map_under(const MapView& map, const FeatureMap& features, const GridPose& pose);

/// Panels beside each other, all with the direction of travel up: imagery of the map (where there is some) and the
/// frame, roads of the map, roads of the frame, their agreement at the true pose, and at the best guess.
/// `imagery` may be empty; poses that are not known give no panel. `frames`: as of seen_from().
cv::Mat agreement_picture(const MapView& map, std::span<const Orthoimage> imagery, const Query& query,
                          std::span<const PlacedFeatures> frames, const Answer& answer);

}  // namespace roadfix::bench
