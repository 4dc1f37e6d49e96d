#include "tiles/world/road_truth.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "core/units/error.hpp"

namespace roadfix::world {
namespace {

using nlohmann::ordered_json;

struct Piece {
  PlanPoint from;
  PlanPoint to;
};

/// Liang and Barsky's clipping of a segment at a box.
std::optional<Piece> clipped_piece(PlanPoint a, PlanPoint b, double width_m, double height_m) {
  const PlanPoint d = b - a;
  double enter = 0.0;
  double leave = 1.0;
  const std::array<std::array<double, 2>, 4> sides{
      {{-d.x, a.x}, {d.x, width_m - a.x}, {-d.y, a.y}, {d.y, height_m - a.y}}};
  for (const auto& [out, room] : sides) {
    if (out == 0.0) {
      if (room < 0.0) return std::nullopt;
    } else if (out < 0.0) {
      enter = std::max(enter, room / out);
    } else {
      leave = std::min(leave, room / out);
    }
  }
  if (enter >= leave) return std::nullopt;
  return Piece{a + d * enter, leave < 1.0 ? a + d * leave : b};  // a + (b - a) may be a rounding beside b
}

/// Value of OpenStreetMap's `surface`; none for a town's streets.
const char* surface_tag(Surface surface) {
  switch (surface) {
    case Surface::kKerbed:
      return nullptr;
    case Surface::kAsphalt:
      return "asphalt";
    case Surface::kGravel:
      return "gravel";
    case Surface::kEarth:
      return "earth";
    case Surface::kSand:
      return "sand";
  }
  return nullptr;
}

ordered_json position_of(LatLon at) {
  constexpr double kPerDegree = 1e8;  // to a millimetre
  return {std::round(kPerDegree * at.lon_deg) / kPerDegree, std::round(kPerDegree * at.lat_deg) / kPerDegree};
}

/// A LineString; cut into several where it crosses the 180th meridian (RFC 7946, section 3.1.9).
ordered_json geometry_of(const Polyline& line, const Placement& placement) {
  ordered_json parts = ordered_json::array({ordered_json::array()});
  std::optional<LatLon> before;
  for (const PlanPoint& p : line) {
    const LatLon at = placement.zone.unproject(placement.point_of(p.x / placement.gsd_m, p.y / placement.gsd_m));
    if (before && std::abs(at.lon_deg - before->lon_deg) > 180.0) {
      const double end = std::copysign(180.0, before->lon_deg);
      const double share = (end - before->lon_deg) / (at.lon_deg + 2.0 * end - before->lon_deg);
      const double lat = std::lerp(before->lat_deg, at.lat_deg, share);
      parts.back().push_back(position_of({lat, end}));
      parts.push_back(ordered_json::array({position_of({lat, -end})}));
    }
    parts.back().push_back(position_of(at));
    before = at;
  }
  if (parts.size() == 1) return {{"type", "LineString"}, {"coordinates", parts.front()}};
  return {{"type", "MultiLineString"}, {"coordinates", std::move(parts)}};
}

ordered_json feature_of(const Street& street, const Polyline& line, const Placement& placement) {
  ordered_json properties{{"highway", street.road_class}, {"width_m", street.width_m}};
  if (const char* surface = surface_tag(street.surface)) properties["surface"] = surface;
  return {{"type", "Feature"}, {"properties", std::move(properties)}, {"geometry", geometry_of(line, placement)}};
}

}  // namespace

std::vector<Polyline> clipped(const Polyline& line, double width_m, double height_m) {
  std::vector<Polyline> parts;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const std::optional<Piece> piece = clipped_piece(line[i], line[i + 1], width_m, height_m);
    if (!piece) continue;
    if (parts.empty() || parts.back().back() != piece->from) parts.push_back({piece->from});
    parts.back().push_back(piece->to);
  }
  return parts;
}

int write_road_truth(const std::string& path, const std::vector<Street>& streets, const Placement& placement) {
  std::ofstream out(path);
  out << R"({"type":"FeatureCollection","name":"roads","features":[)";
  int count = 0;
  for (const Street& street : streets) {
    for (const Polyline& line :
         clipped(street.line, placement.cols * placement.gsd_m, placement.rows * placement.gsd_m)) {
      out << (count++ == 0 ? "\n" : ",\n") << feature_of(street, line, placement).dump();
    }
  }
  out << "\n]}\n";
  if (!out.flush()) throw IoFailure("result-unwritable", fmt::format("{}: cannot be written", path));
  return count;
}

}  // namespace roadfix::world
