#include "tiles/roads/vector_roads.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>

#include "tiles/roads/line_coverage.hpp"
#include "tiles/roads/roads_elsewhere.hpp"
#include "tiles/roads/stated_extent.hpp"
#include "tiles/sources/certainty.hpp"
#include "tiles/sources/fingerprint.hpp"

namespace roadfix {
namespace {

constexpr double kVectorSigmaM = 4.0;
constexpr double kSquareM = 512.0;

struct Segment {
  GridPoint from;
  GridPoint to;
  double half_width_m = 0.0;
};

struct Range {
  double low = 0.0;
  double high = 0.0;
};

/// Eastings of the part of the segment between two northings.
Range eastings_between(const Segment& s, double south_m, double north_m) {
  const double rise = s.to.north_m - s.from.north_m;
  if (rise == 0.0) return {std::min(s.from.east_m, s.to.east_m), std::max(s.from.east_m, s.to.east_m)};
  const auto east_at = [&](double at_m) {
    const double share = std::clamp((at_m - s.from.north_m) / rise, 0.0, 1.0);
    return s.from.east_m + share * (s.to.east_m - s.from.east_m);
  };
  const auto [low, high] = std::minmax({east_at(south_m), east_at(north_m)});
  return {low, high};
}

/// Segments by squares of the plane.
class SegmentIndex {
 public:
  /// Of what reaches into the ground.
  SegmentIndex(const RoadNetwork& network, const GridBox& ground) : ground_(ground) {
    for (const RoadLine& road : network.lines) {
      for (std::size_t i = 0; i + 1 < road.points; ++i) {
        const GridPoint* points = &network.points[road.first_point + i];
        add({points[0], points[1], road.half_width_m});
      }
    }
  }

  template <typename Visit>
  void visit(const GridBox& box, Visit visit) const {
    const Squares rows = squares({box.min.north_m, box.max.north_m});
    const Squares cols = squares({box.min.east_m, box.max.east_m});
    for (int row = rows.first; row <= rows.last; ++row) {
      for (int col = cols.first; col <= cols.last; ++col) {
        const auto found = squares_.find({col, row});
        if (found == squares_.end()) continue;
        for (const Segment& segment : found->second) visit(segment);
      }
    }
  }

 private:
  struct Squares {
    int first = 0;
    int last = -1;
  };

  static Squares squares(Range metres) {
    const auto index = [](double at) { return static_cast<int>(std::floor(std::clamp(at, -1e8, 1e8) / kSquareM)); };
    return {index(metres.low), index(metres.high)};
  }

  /// Row by row, since the box around a long segment holds millions of squares that it is far from.
  void add(const Segment& s) {
    const double r = s.half_width_m;
    const Squares rows = squares({std::max(ground_.min.north_m, std::min(s.from.north_m, s.to.north_m) - r),
                                  std::min(ground_.max.north_m, std::max(s.from.north_m, s.to.north_m) + r)});
    for (int row = rows.first; row <= rows.last; ++row) {
      const Range near = eastings_between(s, row * kSquareM - r, (row + 1) * kSquareM + r);
      const Squares cols =
          squares({std::max(ground_.min.east_m, near.low - r), std::min(ground_.max.east_m, near.high + r)});
      for (int col = cols.first; col <= cols.last; ++col) squares_[{col, row}].push_back(s);
    }
  }

  GridBox ground_;
  std::map<std::pair<int, int>, std::vector<Segment>> squares_;
};

GridBox extent_of(const std::vector<PlanePolygon>& polygons) {
  GridBox extent = polygons.front().box();
  for (const PlanePolygon& polygon : polygons) extent = united(extent, polygon.box());
  return extent;
}

/// The sources and the polygons of their extent, where a file holds them.
std::vector<std::string> files_read(std::vector<std::string> paths, const VectorOptions& options) {
  if (!options.extent.empty() && !box_in_degrees(options.extent)) paths.push_back(options.extent);
  return paths;
}

RoadNetwork network_on_ground(const std::vector<std::string>& paths, const VectorOptions& options,
                              const RoadRules& rules, UtmZone zone) {
  RoadNetwork network = read_road_network(paths, options, rules, zone);
  if (!options.extent.empty()) require_roads_on_ground(network, paths.front(), options.extent, zone);
  return network;
}

/// Of a cell, by how many of its samples a road covers.
std::array<Cell, LineCoverage::kSamples + 1> cells_by_coverage() {
  const Certainty certainty;
  std::array<Cell, LineCoverage::kSamples + 1> cells{};
  for (std::size_t n = 0; n < cells.size(); ++n) {
    cells[n] = cell_from_probability(certainty.probability(static_cast<double>(n) / LineCoverage::kSamples));
  }
  return cells;
}

class RoadVectors final : public CellSource {
 public:
  RoadVectors(const std::vector<std::string>& paths, const VectorOptions& options, const RoadRules& rules, UtmZone zone,
              double cell_m)
      : RoadVectors(network_on_ground(paths, options, rules, zone), cell_m) {
    const Certainty certainty;
    summary_.method =
        fmt::format("drawn roads {} elsewhere {}; {}", certainty.on_road, certainty.elsewhere, rules.describe());
    if (!class_attribute_.empty()) summary_.method += fmt::format("; classes in {}", class_attribute_);
    if (!options.extent.empty()) summary_.method += fmt::format("; extent {}", options.extent);
    if (!options.layer.empty()) summary_.method += fmt::format("; layer {}", options.layer);
    if (!options.crs.empty()) summary_.method += fmt::format("; crs {}", options.crs);
    summary_.fingerprint = fingerprint(files_read(paths, options), summary_.method);
  }

  SourceSummary summary() const override { return summary_; }
  GridBox extent() const override { return extent_; }
  bool touches(const GridBox& box) const override {
    return std::ranges::any_of(covered_, [&](const PlanePolygon& polygon) { return polygon.box().overlaps(box); });
  }

  CellArray read(const GridGeometry& block, std::uint64_t) const override {
    const GridBox box = block.box();
    const auto cells = cells_by_coverage();
    CellArray result(block.cols, block.rows);
    for (const PlanePolygon& polygon : covered_) {
      if (polygon.box().overlaps(box)) polygon.fill(block, cells.front(), result);
    }
    std::optional<LineCoverage> coverage;
    index_.visit(box, [&](const Segment& s) {
      if (!coverage) coverage.emplace(block);
      coverage->add(s.from, s.to, s.half_width_m);
    });
    if (!coverage) return result;
    for (int row = 0; row < block.rows; ++row) {
      for (int col = 0; col < block.cols; ++col) {
        const auto covered = static_cast<std::size_t>(coverage->covered(col, row));
        if (covered > 0 && is_observed(result.at(col, row))) result.at(col, row) = cells[covered];
      }
    }
    return result;
  }

 private:
  RoadVectors(RoadNetwork network, double cell_m)
      : extent_(extent_of(network.covered)),
        index_(network, extent_),
        covered_(std::move(network.covered)),
        class_attribute_(std::move(network.class_attribute)) {
    summary_.kind = SourceKind::kRoadVectors;
    summary_.crs = network.crs;
    summary_.chosen_gsd_m = cell_m;
    summary_.features = static_cast<std::int64_t>(network.lines.size());
    summary_.left_out = network.left_out;
    summary_.registration_sigma_m = std::hypot(kVectorSigmaM, network.datum_sigma_m);
    summary_.notes = std::move(network.notes);
  }

  GridBox extent_;
  SegmentIndex index_;
  std::vector<PlanePolygon> covered_;
  std::string class_attribute_;
  SourceSummary summary_;
};

}  // namespace

std::unique_ptr<CellSource> open_road_vectors(const std::vector<std::string>& paths, const VectorOptions& options,
                                              const RoadRules& rules, UtmZone zone, double cell_m) {
  return std::make_unique<RoadVectors>(paths, options, rules, zone, cell_m);
}

}  // namespace roadfix
