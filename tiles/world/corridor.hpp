// Ground along lines and in areas, as a raster of one metre a cell that reaches a little beyond the picture.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

#include "tiles/world/plan.hpp"

namespace roadfix::world {

class Corridor {
 public:
  static constexpr int kMarginM = 60;

  explicit Corridor(const Plan& plan);

  void add(const Polyline& line, double width_m);
  /// Each by so much more than its width.
  void add(const std::vector<Street>& streets, double wider_m);
  void add_area(const Polyline& outline);

  /// False outside the raster.
  bool contains(PlanPoint p) const;
  /// Of the line's points, sampled every 2 m.
  double share_of(const Polyline& line) const;
  /// Metres from each cell to the nearest of the corridor; look up with at().
  cv::Mat1f distances() const;
  /// The value of such a raster at a point; that at its rim for points outside.
  static double at(const cv::Mat1f& raster, PlanPoint p);

 private:
  cv::Mat1b cells_;
};

/// Pieces of the line, between points of it, that do not touch the corridor.
std::vector<Polyline> outside_of(const Corridor& corridor, const Polyline& line);

}  // namespace roadfix::world
