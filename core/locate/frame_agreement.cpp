#include "core/locate/frame_agreement.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>

#include "core/grid/sampling.hpp"
#include "core/locate/footprint_refusal.hpp"
#include "core/locate/soft_map.hpp"
#include "core/match/correlation.hpp"
#include "core/search/shared_road.hpp"
#include "core/units/planar.hpp"

namespace roadfix {
namespace {

// No two of 54 frames of a drone, placed to about 5 m, correlate by less than 0.2; of frames of different places one in
// 25 pairs reaches 0.15.
constexpr double kLeastCorrelation = 0.15;
constexpr double kLeastRoadsAcross = 0.4;
constexpr int kMostSampledAcross = 128;  // of a frame, whatever its size

/// What two frames show of the ground that both observed.
struct SharedGround {
  MatchSums sums;  ///< by what searches compare
  std::int64_t roads = 0;
  std::int64_t other_roads = 0;
  double sample_m2 = 0.0;

  bool tells() const {
    const double ground_m2 = sample_m2 * static_cast<double>(sums.n);
    const double road_m2 = sample_m2 * static_cast<double>(std::min(roads, other_roads));
    return ground_m2 >= kMinGroundM2 && road_m2 >= kLeastRoadsAcross * kRoadWidthM * std::sqrt(ground_m2);
  }
};

struct Frame {
  PlacedFeatures placed;
  FeatureMap soft;
};

SharedGround shared_ground(const Frame& frame, const Frame& other) {
  const FeatureMap& features = frame.placed.features;
  const CellArray& cells = features.cells;
  const BodyOffset offset = offset_from(moved({}, frame.placed.offset), moved({}, other.placed.offset));
  const Placement placement = placement_in({other.placed.features, offset}, features.nadir);
  const int step = 1 + (std::max(cells.cols(), cells.rows()) - 1) / kMostSampledAcross;
  SharedGround shared;
  shared.sample_m2 = std::pow(step * features.cell_m, 2.0);
  for (int row = 0; row < cells.rows(); row += step) {
    for (int col = 0; col < cells.cols(); col += step) {
      if (!is_observed(cells.at(col, row))) continue;
      const GridGeometry::CellPosition there = placement.source_of(col + 0.5, row + 0.5);
      const Cell seen = bilinear(other.placed.features.cells, there);
      if (!is_observed(seen)) continue;
      shared.sums.add(probability(bilinear(other.soft.cells, there)), probability(frame.soft.cells.at(col, row)));
      shared.roads += is_road(cells.at(col, row)) ? 1 : 0;
      shared.other_roads += is_road(seen) ? 1 : 0;
    }
  }
  return shared;
}

/// 1 where they contradict each other, -1 where they agree, 0 where nothing tells.
int contradiction_of(const Frame& frame, const Frame& other) {
  const SharedGround shared = shared_ground(frame, other);
  const std::optional<double> correlation = pearson(shared.sums);
  if (!correlation || !shared.tells()) return 0;
  return *correlation < kLeastCorrelation ? 1 : -1;
}

using Contradictions = std::vector<std::vector<int>>;

Contradictions contradictions_of(std::span<const PlacedFeatures> parts) {
  std::vector<Frame> frames;
  for (const PlacedFeatures& part : parts) frames.push_back({part, softened(part.features)});
  Contradictions result(parts.size(), std::vector<int>(parts.size()));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    for (std::size_t j = i + 1; j < frames.size(); ++j) {
      result[i][j] = result[j][i] = contradiction_of(frames[i], frames[j]);
    }
  }
  return result;
}

/// By how many more of `others` a frame is contradicted than agreed with.
int majority_against(std::size_t frame, std::span<const std::size_t> others, const Contradictions& contradictions) {
  int majority = 0;
  for (const std::size_t other : others) majority += contradictions[frame][other];
  return majority;
}

/// Those with the largest majority against them, as far as others bear it out: of two that only contradict each other
/// nobody knows which is wrong. Empty where there is no majority.
std::vector<std::size_t> most_contradicted(const Contradictions& contradictions, std::span<const std::size_t> frames) {
  std::vector<std::size_t> found;
  std::vector<std::size_t> others;
  int most = 1;
  for (const std::size_t frame : frames) most = std::max(most, majority_against(frame, frames, contradictions));
  for (const std::size_t frame : frames) {
    (majority_against(frame, frames, contradictions) == most ? found : others).push_back(frame);
  }
  std::erase_if(found, [&](std::size_t frame) { return majority_against(frame, others, contradictions) <= 0; });
  return found;
}

}  // namespace

std::vector<std::size_t> contradicting_frames(std::span<const PlacedFeatures> parts) {
  const Contradictions contradictions = contradictions_of(parts);
  std::vector<std::size_t> rest(parts.size());
  std::iota(rest.begin(), rest.end(), std::size_t{0});
  std::vector<std::size_t> result;
  for (;;) {
    const std::vector<std::size_t> most = most_contradicted(contradictions, rest);
    if (most.empty()) break;
    for (const std::size_t frame : most) std::erase(rest, frame);
    result.insert(result.end(), most.begin(), most.end());
  }
  if (result.size() >= rest.size()) return {};
  std::ranges::sort(result);
  return result;
}

}  // namespace roadfix
