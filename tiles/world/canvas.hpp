// One tile of a picture while it is being painted: colour, what the surface is made of, and how high it is.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

#include "tiles/world/plan.hpp"

namespace roadfix::world {

/// How much a surface's brightness varies, see tiles/world/texture.
enum class Material : std::uint8_t { kBare, kPaved, kAsphalt, kGrass, kRoof, kLeaves, kSmooth, kRubble };

class Canvas {
 public:
  /// `pixels` is the tile's place in the picture, margin included; it may reach beyond the picture.
  Canvas(cv::Rect pixels, double gsd_m);

  /// Whether anything within the radius can be on this tile.
  bool sees(PlanPoint centre, double radius_m) const;
  /// The same of a polygon, by the circle around its box.
  bool sees(const Polyline& outline) const;

  /// A polygon with smooth edges. Its height, where given, replaces what stood there: metres above the ground.
  void fill(const Polyline& polygon, const Colour& colour, Material material);
  void fill(const Polyline& polygon, const Colour& colour, Material material, double height_m);
  /// The same of a circle; a height of 0 leaves what stood there.
  void disc(PlanPoint centre, double radius_m, const Colour& colour, Material material, double height_m);
  /// A band along the line, round at its bends and ends.
  void stroke(const Polyline& line, double width_m, const Colour& colour, Material material);

  const cv::Rect& pixels() const { return pixels_; }
  double gsd_m() const { return gsd_m_; }
  /// Of each pixel of the tile: red, green, blue; a Material; metres above the ground.
  cv::Mat3b& colour() { return colour_; }
  const cv::Mat1b& material() const { return material_; }
  const cv::Mat1f& height() const { return height_; }

 private:
  void fill_shape(const Polyline& polygon, const Colour& colour, Material material, const double* height_m);
  cv::Point on_tile(PlanPoint p) const;

  cv::Rect pixels_;
  double gsd_m_;
  cv::Rect2d ground_;  ///< plan coordinates, metres
  cv::Mat3b colour_;
  cv::Mat1b material_;
  cv::Mat1f height_;
};

}  // namespace roadfix::world
