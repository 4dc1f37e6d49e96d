#include "tiles/world/real_streets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/units/error.hpp"
#include "tiles/roads/road_lines.hpp"
#include "tiles/sources/source_files.hpp"
#include "tiles/world/polygon.hpp"
#include "tiles/world/street_network.hpp"

namespace roadfix::world {
namespace {

constexpr double kSurroundingsM = 150.0;

Polyline plan_line(const RoadNetwork& network, const RoadLine& road, const Placement& placement) {
  Polyline result;
  for (std::size_t i = 0; i < road.points; ++i) {
    const GridPoint p = network.points[road.first_point + i];
    result.emplace_back(p.east_m - placement.north_west.east_m, placement.north_west.north_m - p.north_m);
  }
  return result;
}

bool touches(const Polyline& line, const cv::Rect2d& area) {
  const cv::Rect2d box = box_of(line);
  return box.br().x >= area.x && box.x <= area.br().x && box.br().y >= area.y && box.y <= area.br().y;
}

cv::Rect2d picture(const Placement& placement, double margin_m) {
  return {-margin_m, -margin_m, placement.cols * placement.gsd_m + 2.0 * margin_m,
          placement.rows * placement.gsd_m + 2.0 * margin_m};
}

/// The extent of a large country may have no place in the zone; the picture has.
VectorOptions around(const Placement& placement, const cv::Rect2d& wanted) {
  const GridPoint corner = placement.north_west;
  const LatLon low = placement.zone.unproject({corner.east_m + wanted.x, corner.north_m - wanted.y - wanted.height});
  const LatLon high = placement.zone.unproject({corner.east_m + wanted.x + wanted.width, corner.north_m - wanted.y});
  VectorOptions options;
  options.extent = fmt::format("{},{},{},{}", low.lon_deg, low.lat_deg, high.lon_deg, high.lat_deg);
  return options;
}

}  // namespace

std::vector<std::string> road_files(const std::string& source) {
  SourceFiles files = find_source(source, SourceContent::kRoads);
  const bool is_one_file = files.paths == std::vector{source};  // it may hold lines beside pixels
  if (files.kind == SourceKind::kRoadVectors || is_one_file) return std::move(files.paths);
  throw InvalidInput("world-roads-are-pictures",
                     fmt::format("{}: holds pictures ({} is one), and streets are made of lines: name a file of road "
                                 "lines, or a folder of such files alone",
                                 source, files.paths.front()));
}

std::vector<Street> read_streets(const std::string& source, const Placement& placement) {
  const cv::Rect2d wanted = picture(placement, kSurroundingsM);
  const RoadNetwork network =
      read_road_network(road_files(source), around(placement, wanted), RoadRules(), placement.zone);
  std::vector<Street> streets;
  for (const RoadLine& road : network.lines) {
    Polyline line = plan_line(network, road, placement);
    if (!touches(line, wanted)) continue;
    const std::string& road_class = network.classes[road.road_class];
    streets.push_back({road_class.empty() ? "road" : road_class, 2.0 * road.half_width_m, std::move(line)});
  }
  if (std::ranges::none_of(streets, [&](const Street& s) { return touches(s.line, picture(placement, 0.0)); })) {
    throw InvalidInput(
        "world-without-roads",
        fmt::format("{}: no road of it lies in the picture around the chosen centre; name a place inside "
                    "its extent with --centre",
                    source));
  }
  sort_by_width(streets);
  return streets;
}

}  // namespace roadfix::world
