#include "server/api/window.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/grid/resample.hpp"
#include "core/units/error.hpp"
#include "server/api/feature_json.hpp"
#include "server/api/geojson.hpp"
#include "server/api/json_parts.hpp"

namespace roadfix::api {
namespace {

using nlohmann::json;

constexpr double kMaxSideM = 1'000'000.0;
constexpr double kMaxWindowCellM = 4096.0;

/// The coarsest cells of the map that are not larger than the window's.
double level_cell_within(const MapView& map, double cell_m) {
  double source = map.cell_m;
  while (2.0 * source <= cell_m && 2.0 * source <= kMaxWindowCellM) source *= 2.0;
  return source;
}

GridBox box_around(const GridPose& pose, double width_m, double height_m, double margin_m) {
  const double c = std::abs(cos(pose.heading));
  const double s = std::abs(sin(pose.heading));
  const double east = 0.5 * (width_m * c + height_m * s) + margin_m;
  const double north = 0.5 * (width_m * s + height_m * c) + margin_m;
  const GridPoint p = pose.position;
  return {{p.east_m - east, p.north_m - north}, {p.east_m + east, p.north_m + north}};
}

/// What of the map lies within the box. Around a long window on a slant that is far more than the window itself.
RoadGrid ground_within(const MapView& map, const GridBox& box, double source_m, const Limits& limits) {
  constexpr double kMaxRead = 16.0;  // cells for each that may be asked for; of a square on a slant at most 8
  const GridBox needed = intersection(box, grown(map.extent, source_m));
  const double cols = needed.width_m() / source_m;
  const double rows = needed.height_m() / source_m;
  if (cols * rows > kMaxRead * static_cast<double>(limits.cells)) {
    throw LimitExceeded("too-many-cells",
                        fmt::format("the window lies on a slant, and {:.0f} x {:.0f} cells of the map around it would "
                                    "have to be read: ask for parts of it",
                                    cols, rows));
  }
  return map.read(GridGeometry::covering(needed, source_m));
}

/// A centre from which a window of so many cells ends on the lattice.
double snapped(double centre_m, int cells, double cell_m) {
  const double edge = centre_m - 0.5 * cells * cell_m;
  return std::round(edge / cell_m) * cell_m + 0.5 * cells * cell_m;
}

GridPoint corner(const Window& window, double col, double row) {
  const auto transform = geotransform(window);
  return {transform[0] + col * transform[1] + row * transform[2],
          transform[3] + col * transform[4] + row * transform[5]};
}

json footprint(const Window& window) {
  const double cols = window.cells.cells.cols();
  const double rows = window.cells.cells.rows();
  std::vector<LatLon> ring;
  for (const auto& [col, row] : {std::pair{0.0, 0.0}, {0.0, rows}, {cols, rows}, {cols, 0.0}, {0.0, 0.0}}) {
    ring.push_back(window.zone.unproject(corner(window, col, row)));
  }
  return polygon_json(ring);
}

}  // namespace

const std::vector<std::string>& window_fields() {
  static const std::vector<std::string> kFields{"lat", "lon", "width_m", "height_m", "cell_m", "heading_deg", "format"};
  return kFields;
}

WindowRequest parse_window(const Fields& fields) {
  WindowRequest request;
  request.centre = {fields.number("lat", kLatitude), fields.number("lon", kLongitude)};
  request.width_m = fields.number("width_m", {0.0, kMaxSideM, true});
  request.height_m = fields.number("height_m", {0.0, kMaxSideM, true});
  request.cell_m = fields.optional_number("cell_m", {0.0, kMaxWindowCellM, true});
  request.heading = fields.optional_angle("heading_deg", kDegrees);
  return request;
}

Window cut_window(const MapView& map, const WindowRequest& request, const Limits& limits) {
  const double cell_m = request.cell_m.value_or(map.cell_m);
  const double cols = std::max(1.0, std::round(request.width_m / cell_m));
  const double rows = std::max(1.0, std::round(request.height_m / cell_m));
  if (cols * rows > static_cast<double>(limits.cells)) {
    throw LimitExceeded(
        "too-many-cells",
        fmt::format("the window would have {:.0f} x {:.0f} cells, more than {}: ask for a smaller one or "
                    "for larger cells",
                    cols, rows, limits.cells));
  }
  const int n_cols = static_cast<int>(cols);
  const int n_rows = static_cast<int>(rows);
  const double source_m = level_cell_within(map, cell_m);
  GridPose pose{map.zone.project(request.centre), Angle{}};
  if (request.heading) {
    pose.heading = map.zone.grid_from_true(*request.heading, pose.position);
  } else if (source_m == cell_m) {
    pose.position = {snapped(pose.position.east_m, n_cols, cell_m), snapped(pose.position.north_m, n_rows, cell_m)};
  }
  if (!box_around(pose, cols * cell_m, rows * cell_m, 0.0).overlaps(map.extent)) {
    throw InvalidInput(
        "window-outside-map",
        fmt::format("the window lies outside the map {}: GET /v1/maps/{} gives its extent", map.id.name, map.id.name));
  }
  const GridBox around = box_around(pose, cols * cell_m, rows * cell_m, 2.0 * source_m);
  return {cut_out(ground_within(map, around, source_m, limits), pose, n_cols, n_rows, cell_m),
          pose,
          {map.zone.unproject(pose.position), map.zone.true_from_grid(pose.heading, pose.position)},
          map.zone,
          map.id};
}

std::array<double, 6> geotransform(const Window& window) {
  const double cell_m = window.cells.cell_m;
  const double c = cell_m * cos(window.grid_pose.heading);
  const double s = cell_m * sin(window.grid_pose.heading);
  const double half_cols = window.cells.cells.cols() / 2.0;
  const double half_rows = window.cells.cells.rows() / 2.0;
  const GridPoint p = window.grid_pose.position;
  // Columns run right of the heading: (c, -s) east and north; rows run back: (-s, -c).
  return {p.east_m - half_cols * c + half_rows * s, c, 0.0 - s, p.north_m + half_cols * s + half_rows * c, 0.0 - s, -c};
}

json to_json(const Window& window) {
  json answer = to_json(window.cells);
  answer["pose"] = pose_json(window.pose);
  answer["map"] = to_json(window.map);
  answer["footprint"] = footprint(window);
  answer["epsg"] = window.zone.epsg();
  answer["geotransform"] = geotransform(window);
  return answer;
}

}  // namespace roadfix::api
