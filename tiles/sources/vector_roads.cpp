#include "tiles/sources/vector_roads.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include "tiles/sources/fingerprint.hpp"
#include "tiles/sources/line_coverage.hpp"

namespace roadfix {
namespace {

constexpr double kVectorSigmaM = 4.0;
constexpr double kBucketM = 512.0;

bool overlap(const GridBox& a, const GridBox& b) {
  return a.min.east_m < b.max.east_m && b.min.east_m < a.max.east_m && a.min.north_m < b.max.north_m &&
         b.min.north_m < a.max.north_m;
}

/// Segments by squares of the plane.
class SegmentIndex {
 public:
  explicit SegmentIndex(const RoadNetwork& network) {
    for (std::size_t line = 0; line < network.lines.size(); ++line) {
      const RoadLine& road = network.lines[line];
      for (std::size_t i = 0; i + 1 < road.points; ++i) {
        const GridPoint a = network.points[road.first_point + i];
        const GridPoint b = network.points[road.first_point + i + 1];
        const double r = road.half_width_m;
        const GridBox box{{std::min(a.east_m, b.east_m) - r, std::min(a.north_m, b.north_m) - r},
                          {std::max(a.east_m, b.east_m) + r, std::max(a.north_m, b.north_m) + r}};
        for_each_square(box, [&](Square square) { squares_[square].push_back({a, b, r}); });
      }
    }
  }

  template <typename Visit>
  void visit(const GridBox& box, Visit visit) const {
    for_each_square(box, [&](Square square) {
      const auto found = squares_.find(square);
      if (found == squares_.end()) return;
      for (const Segment& segment : found->second) visit(segment.from, segment.to, segment.half_width_m);
    });
  }

 private:
  struct Segment {
    GridPoint from;
    GridPoint to;
    double half_width_m;
  };
  using Square = std::pair<int, int>;

  template <typename Visit>
  static void for_each_square(const GridBox& box, Visit visit) {
    const auto index = [](double metres) {
      return static_cast<int>(std::floor(std::clamp(metres, -1e8, 1e8) / kBucketM));
    };
    for (int row = index(box.min.north_m); row <= index(box.max.north_m); ++row) {
      for (int col = index(box.min.east_m); col <= index(box.max.east_m); ++col) visit(Square(col, row));
    }
  }

  std::map<Square, std::vector<Segment>> squares_;
};

class RoadVectors final : public CellSource {
 public:
  RoadVectors(const std::vector<std::string>& paths, const VectorOptions& options, const RoadRules& rules, UtmZone zone,
              double cell_m)
      : RoadVectors(read_road_network(paths, options, rules, zone), cell_m) {
    const Certainty certainty;
    summary_.method =
        fmt::format("drawn roads {} elsewhere {}; {}", certainty.on_road, certainty.elsewhere, rules.describe());
    if (!class_attribute_.empty()) summary_.method += fmt::format("; classes in {}", class_attribute_);
    if (!options.extent.empty()) summary_.method += fmt::format("; extent {}", options.extent);
    if (!options.layer.empty()) summary_.method += fmt::format("; layer {}", options.layer);
    if (!options.crs.empty()) summary_.method += fmt::format("; crs {}", options.crs);
    summary_.fingerprint = fingerprint(paths, summary_.method);
  }

  SourceSummary summary() const override { return summary_; }
  GridBox extent() const override { return extent_; }
  bool touches(const GridBox& box) const override {
    return std::ranges::any_of(covered_, [&](const PlanePolygon& polygon) { return overlap(polygon.box(), box); });
  }

  CellArray read(const GridGeometry& block, std::uint64_t) const override {
    const GridBox box = block.box();
    std::vector<bool> inside(static_cast<std::size_t>(block.cols) * static_cast<std::size_t>(block.rows), false);
    for (const PlanePolygon& polygon : covered_) {
      if (overlap(polygon.box(), box)) polygon.mark(block, inside);
    }
    LineCoverage coverage(block);
    index_.visit(box, [&](GridPoint from, GridPoint to, double half_width_m) { coverage.add(from, to, half_width_m); });
    const Certainty certainty;
    CellArray result(block.cols, block.rows);
    std::size_t i = 0;
    for (int row = 0; row < block.rows; ++row) {
      for (int col = 0; col < block.cols; ++col) {
        if (inside[i++]) result.at(col, row) = cell_from_probability(certainty.probability(coverage.share(col, row)));
      }
    }
    return result;
  }

 private:
  RoadVectors(RoadNetwork network, double cell_m)
      : index_(network), covered_(std::move(network.covered)), class_attribute_(std::move(network.class_attribute)) {
    extent_ = covered_.front().box();
    for (const PlanePolygon& polygon : covered_) {
      const GridBox& box = polygon.box();
      extent_.min = {std::min(extent_.min.east_m, box.min.east_m), std::min(extent_.min.north_m, box.min.north_m)};
      extent_.max = {std::max(extent_.max.east_m, box.max.east_m), std::max(extent_.max.north_m, box.max.north_m)};
    }
    summary_.kind = "roads";
    summary_.crs = network.crs;
    summary_.chosen_gsd_m = cell_m;
    summary_.features = static_cast<std::int64_t>(network.lines.size());
    summary_.left_out = network.left_out;
    summary_.registration_sigma_m = kVectorSigmaM;
    summary_.notes = std::move(network.notes);
  }

  SegmentIndex index_;
  std::vector<PlanePolygon> covered_;
  std::string class_attribute_;
  GridBox extent_;
  SourceSummary summary_;
};

}  // namespace

std::unique_ptr<CellSource> open_road_vectors(const std::vector<std::string>& paths, const VectorOptions& options,
                                              const RoadRules& rules, UtmZone zone, double cell_m) {
  return std::make_unique<RoadVectors>(paths, options, rules, zone, cell_m);
}

}  // namespace roadfix
