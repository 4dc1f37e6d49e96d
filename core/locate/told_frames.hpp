// Several frames as one, laid together by movements that somebody told.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/grid/combine.hpp"

namespace roadfix {

/// Of the way between two frames, 1 sigma: odometry of which a track is told nothing is taken to be that good, too.
inline constexpr double kToldOffsetShare = 0.05;

struct FramesTogether {
  FeatureMap features;
  std::vector<std::size_t> left_out;  ///< contradicting_frames(): the rest are laid together
};

/// combined(), its nadir known no better than the offsets: the roads of a frame tell where that one was taken, and its
/// offset, where the reference was. Each counts by how much road it has to tell places apart. Throws as combined(),
/// LimitExceeded ("frames-too-far-apart") also where they show little ground for that (ground_reach()), and
/// InvalidInput ("frames-repeated") where one picture is said to have been taken at two places.
FramesTogether laid_together(std::span<const PlacedFeatures> parts, double max_cells);

}  // namespace roadfix
