// What stands where in a rendered world, before any pixel: streets, blocks, buildings, trees, boxes, debris.
//
// Plan coordinates: metres from the picture's north-western corner, x east, y *south*, as pixels run.
#pragma once

#include <cstdint>
#include <functional>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace roadfix::world {

using PlanPoint = cv::Point2d;
using Polyline = std::vector<PlanPoint>;
/// Red, green, blue in 0..255.
using Colour = cv::Vec3d;

struct Street {
  std::string road_class;  ///< value of OpenStreetMap's `highway`
  double width_m = 6.0;    ///< of the carriageway
  Polyline line;
};

enum class LandUse { kVerge, kHouses, kApartments, kHalls, kPark, kYard, kWaste, kField, kOrchard, kForest };

/// Ground that streets enclose, without sidewalks.
struct Block {
  LandUse use = LandUse::kVerge;
  Polyline outline;
  double area_m2 = 0.0;
};

/// A rectangle on the ground: `length` along `angle_rad` (from x towards y), `width` across.
struct Footprint {
  PlanPoint center;
  double angle_rad = 0.0;
  double length_m = 0.0;
  double width_m = 0.0;

  PlanPoint at(double along_m, double across_m) const;
  /// The four corners, `margin_m` outside the rectangle.
  Polyline corners(double margin_m = 0.0) const;
  double radius_m() const;
};

enum class Roof { kFlat, kHipped, kMetal };

struct Building {
  Footprint footprint;
  double height_m = 3.0;
  Roof roof = Roof::kFlat;
  Colour roof_colour{};
  Colour facade_colour{};
  Colour lot_colour{};
  std::uint64_t detail_seed = 0;
};

struct Tree {
  PlanPoint center;
  double radius_m = 2.0;
  double height_m = 5.0;
  double tone = 1.0;       ///< brightness, about 1
  bool deciduous = false;  ///< bare in winter
};

/// A car, a bus, a tent, a container.
struct Box {
  Footprint footprint;
  double height_m = 1.5;
  Colour colour;
};

/// What is left of a building, spilled over what lies around.
struct Debris {
  Footprint footprint;
  double height_m = 3.0;
  std::uint64_t seed = 0;
};

struct Plan {
  double width_m = 0.0;
  double height_m = 0.0;
  std::vector<Street> streets;  ///< wider ones last
  Polyline river;               ///< empty where there is none
  double river_width_m = 0.0;
  std::vector<Block> blocks;
  std::vector<Building> buildings;
  std::vector<Tree> trees;
  std::vector<Box> boxes;
  std::vector<Debris> debris;
};

double length_m(const Polyline& line);
/// Direction of the segment that starts at `index`, as a unit vector.
PlanPoint direction(const Polyline& line, std::size_t index);

/// Calls visit(point, unit direction) every `step_m` along the line, starting at `start_m`.
void walk(const Polyline& line, double start_m, double step_m, const std::function<void(PlanPoint, PlanPoint)>& visit);

}  // namespace roadfix::world
