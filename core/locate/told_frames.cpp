#include "core/locate/told_frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/grid/cell_moments.hpp"
#include "core/locate/footprint_refusal.hpp"
#include "core/locate/frame_agreement.hpp"
#include "core/locate/same_view.hpp"
#include "core/locate/soft_map.hpp"
#include "core/units/error.hpp"

namespace roadfix {
namespace {

/// How much of what the search compares can tell places apart.
double evidence_of(const FeatureMap& features) { return moments_of(softened(features).cells).squared_deviations(); }

/// How far from the reference what tells its place was seen from, in the mean.
double mean_distance_m(std::span<const PlacedFeatures> parts) {
  double weights = 0.0;
  double sum_m = 0.0;
  for (const PlacedFeatures& part : parts) {
    const double weight = evidence_of(part.features);
    weights += weight;
    sum_m += weight * distance_m(part.offset);
  }
  return weights > 0.0 ? sum_m / weights : 0.0;
}

bool is_apart(const BodyOffset& a, const BodyOffset& b) {
  return has_moved(std::hypot(b.forward_m - a.forward_m, b.right_m - a.right_m),
                   angular_distance(a.turn, b.turn).radians());
}

/// A camera or a link that has stopped shows one picture again and again.
void refuse_repeated(std::span<const PlacedFeatures> parts) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (std::size_t j = i + 1; j < parts.size(); ++j) {
      if (!is_apart(parts[i].offset, parts[j].offset) || !is_same_view(parts[i].features, parts[j].features)) continue;
      throw InvalidInput("frames-repeated",
                         fmt::format("frames {} and {} are the same picture, though taken at different places or "
                                     "headings: check the camera and its link, or leave one of them out",
                                     i + 1, j + 1));
    }
  }
}

void refuse_far_apart(const FeatureMap& together) {
  const GroundReach reach = ground_reach(together);
  if (!reach.too_far()) return;
  throw LimitExceeded("frames-too-far-apart",
                      fmt::format("together the frames show ground up to {:.0f} m from where the first was taken, and "
                                  "at most {:.0f} m are allowed for as much as they show: check their offsets, or "
                                  "leave the farthest out",
                                  reach.farthest_m, reach.allowed_m));
}

std::vector<PlacedFeatures> all_but(std::span<const std::size_t> left_out, std::span<const PlacedFeatures> parts) {
  std::vector<PlacedFeatures> rest;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (!std::ranges::binary_search(left_out, i)) rest.push_back(parts[i]);
  }
  return rest;
}

}  // namespace

FramesTogether laid_together(std::span<const PlacedFeatures> parts, double max_cells) {
  FramesTogether result{combined(parts, max_cells), {}};
  FeatureMap& features = result.features;
  refuse_far_apart(features);
  refuse_repeated(parts);
  result.left_out = contradicting_frames(parts);
  const std::vector<PlacedFeatures> rest = all_but(result.left_out, parts);
  if (rest.size() < parts.size()) features = combined(rest, max_cells);
  features.nadir_sigma_m = std::hypot(features.nadir_sigma_m, kToldOffsetShare * mean_distance_m(rest));
  return result;
}

}  // namespace roadfix
