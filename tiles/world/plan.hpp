// What stands where in a rendered world, before any pixel: streets, blocks, buildings, trees, boxes, debris;
// fields, woods, water and rails of the open country.
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

/// What a carriageway is made of; kKerbed is a town's street between sidewalks.
enum class Surface { kKerbed, kAsphalt, kGravel, kEarth, kSand };

struct Street {
  std::string road_class;  ///< value of OpenStreetMap's `highway`
  double width_m = 6.0;    ///< of the carriageway
  Polyline line;
  Surface surface = Surface::kKerbed;
  bool grass_strip = false;  ///< between two wheel marks
  double wear = 1.0;         ///< share of the ground's cover that wheels have taken
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
  PlanPoint centre;
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

enum class Crown { kGarden, kBroadleaf, kConifer, kShrub };

struct Tree {
  PlanPoint centre;
  double radius_m = 2.0;
  double height_m = 5.0;
  double tone = 1.0;       ///< brightness, about 1
  bool deciduous = false;  ///< bare in winter
  Crown crown = Crown::kGarden;
  Colour leaf{};  ///< these two not of garden trees, which are all alike
  Colour autumn{};
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

enum class Cover { kWood, kMeadow, kScrub, kCrop, kPlough, kStubble, kOrchard };

/// A piece of the country with one cover.
struct Parcel {
  Cover cover = Cover::kMeadow;
  Polyline outline;
  Colour summer{};
  Colour winter{};
  double row_angle_rad = 0.0;  ///< of drilling, plough and mower
  std::uint64_t seed = 0;
};

/// A narrow band that is no road: a field's margin, a ditch, a fire break, a footpath.
struct Strip {
  Polyline line;
  double width_m = 1.0;
  Colour colour{};
  bool open = false;  ///< without trees
};

/// A tree that lies.
struct Log {
  PlanPoint foot;
  PlanPoint top;
  double crown_m = 3.0;
  Colour leaf{};
};

/// Earth and stones that came down.
struct Slide {
  Polyline outline;
  Colour colour{};
  std::uint64_t seed = 0;
};

/// What only the open country has; empty in a town.
struct Countryside {
  Colour soil{};
  Colour grass{};
  std::vector<Parcel> parcels;
  std::vector<Strip> strips;
  std::vector<Polyline> hedges;
  std::vector<Polyline> ponds;
  Polyline railway;
  std::vector<Log> logs;
  std::vector<Slide> slides;
};

struct Plan {
  double width_m = 0.0;
  double height_m = 0.0;
  std::vector<Street> streets;  ///< wider ones last
  Polyline river;               ///< empty where there is none
  double river_width_m = 0.0;
  Colour water{74.0, 92.0, 86.0};
  std::vector<Block> blocks;
  std::vector<Building> buildings;
  std::vector<Tree> trees;
  std::vector<Box> boxes;
  std::vector<Debris> debris;
  Countryside country;

  double square_km() const { return width_m * height_m / 1e6; }
};

inline PlanPoint perpendicular(PlanPoint along) { return {-along.y, along.x}; }

double length_m(const Polyline& line);
/// Direction of the segment that starts at `index`, as a unit vector.
PlanPoint direction(const Polyline& line, std::size_t index);
/// The point of that index, moved to the side.
PlanPoint beside(const Polyline& line, std::size_t index, double off_m);

/// Calls visit(point, unit direction) every `step_m` along the line, starting at `start_m`.
void walk(const Polyline& line, double start_m, double step_m, const std::function<void(PlanPoint, PlanPoint)>& visit);

}  // namespace roadfix::world
