#include "tiles/roads/roads_elsewhere.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "core/units/error.hpp"
#include "tiles/roads/line_boxes.hpp"

namespace roadfix {
namespace {

/// Whether one would meet the other if x and y of either were swapped.
bool meet_swapped(const OGREnvelope& roads, const OGREnvelope& ground) {
  OGREnvelope swapped;
  swapped.MinX = ground.MinY;
  swapped.MaxX = ground.MaxY;
  swapped.MinY = ground.MinX;
  swapped.MaxY = ground.MaxX;
  return roads.Intersects(swapped) != FALSE;
}

}  // namespace

void require_roads_on_ground(const RoadNetwork& network, const std::string& path, const std::string& extent,
                             UtmZone zone) {
  std::vector<GridBox> ground;
  for (const PlanePolygon& polygon : network.covered) ground.push_back(polygon.box());
  const auto on_ground = [&](const RoadLine& road) {
    const GridBox box = box_of(network, road);
    return std::ranges::any_of(ground, [&](const GridBox& part) { return !intersection(part, box).empty(); });
  };
  if (std::ranges::any_of(network.lines, on_ground)) return;
  const std::optional<OGREnvelope> of_roads = box_on_earth(united(boxes_of(network, network.lines)), zone);
  const std::optional<OGREnvelope> of_ground = box_on_earth(united(ground), zone);
  std::string remedy = "Name ground that holds them";
  if (of_roads && of_ground && meet_swapped(*of_roads, *of_ground)) {
    remedy += "; latitude and longitude may be swapped in one of the two, and W,S,E,N begins with a longitude";
  }
  throw InvalidInput(
      "source-without-roads",
      fmt::format("{}: none of its {} roads lies in --extent {}{}. {}", path, network.lines.size(), extent,
                  of_roads ? fmt::format("; they lie in {}", extent_text(*of_roads)) : "", remedy));
}

}  // namespace roadfix
