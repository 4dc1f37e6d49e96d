#include "tiles/roads/stray_roads.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "tiles/roads/line_boxes.hpp"

namespace roadfix {
namespace {

constexpr std::size_t kOutermost = 20;  // one of so many on each side is not of the middle
constexpr double kMaxStray = 0.05;
constexpr double kMinRatio = 4.0;
constexpr double kWorthNotingM2 = 10e6;

double area_m2(const GridBox& box) { return box.width_m() * box.height_m(); }

bool holds(const GridBox& box, const GridBox& part) { return box.contains(part.min) && box.contains(part.max); }

struct Core {
  GridBox box;
  std::int64_t boxes = 0;
};

/// What lies in the middle nine tenths and around it, as far as they are wide.
Core core_of(std::span<const GridBox> boxes) {
  const GridBox middle = middle_of(boxes, kOutermost);
  const GridBox around = grown(middle, std::max(middle.width_m(), middle.height_m()));
  Core core{middle};
  for (const GridBox& box : boxes) {
    if (!holds(around, box)) continue;
    core.box = united(core.box, box);
    ++core.boxes;
  }
  return core;
}

/// In letters where it has none.
std::string extent_around(const GridBox& box, UtmZone zone) {
  const std::optional<OGREnvelope> degrees = box_on_earth(box, zone);
  return degrees ? extent_text(*degrees) : "W,S,E,N";
}

std::string sides(const GridBox& box) {
  return fmt::format("{:.1f} x {:.1f} km", box.width_m() / 1e3, box.height_m() / 1e3);
}

}  // namespace

std::optional<std::string> note_on_stray_roads(const RoadNetwork& network, std::span<const RoadLine> lines,
                                               const GridBox& ground, UtmZone zone) {
  if (lines.size() < kOutermost) return std::nullopt;
  const std::vector<GridBox> boxes = boxes_of(network, lines);
  const Core core = core_of(boxes);
  const auto strays = static_cast<double>(std::ssize(boxes) - core.boxes);
  const double ground_m2 = area_m2(ground);
  if (strays > kMaxStray * static_cast<double>(boxes.size()) || ground_m2 < kMinRatio * area_m2(core.box) ||
      ground_m2 - area_m2(core.box) < kWorthNotingM2) {
    return std::nullopt;
  }
  return fmt::format(
      "{} of its {} roads lie within {}, but {} count as seen, and as no road wherever none is drawn. If that is not "
      "so, --extent {} keeps to the smaller ground",
      core.boxes, boxes.size(), sides(core.box), sides(ground), extent_around(core.box, zone));
}

}  // namespace roadfix
