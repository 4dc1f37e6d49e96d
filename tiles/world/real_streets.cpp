#include "tiles/world/real_streets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>

#include "core/units/error.hpp"
#include "tiles/sources/osm_tags.hpp"
#include "tiles/sources/road_rules.hpp"
#include "tiles/sources/vector_file.hpp"
#include "tiles/world/street_network.hpp"

namespace roadfix::world {
namespace {

constexpr double kSurroundingsM = 150.0;

std::string tag_of(const OGRFeature& feature, std::string_view key) {
  const int field = feature.GetFieldIndex(std::string(key).c_str());
  if (field >= 0 && feature.IsFieldSetAndNotNull(field) != 0) return feature.GetFieldAsString(field);
  const int packed = feature.GetFieldIndex("other_tags");
  if (packed < 0 || feature.IsFieldSetAndNotNull(packed) == 0) return {};
  const auto tags = parse_hstore(feature.GetFieldAsString(packed));
  const auto found = tags.find(key);
  return found != tags.end() ? found->second : std::string();
}

/// Calls visit for each line of the geometry, however deep it is nested.
void for_each_line(const OGRGeometry& geometry, const std::function<void(const OGRLineString&)>& visit) {
  const OGRwkbGeometryType type = wkbFlatten(geometry.getGeometryType());
  if (type == wkbLineString) {
    visit(*geometry.toLineString());
  } else if (type == wkbMultiLineString || type == wkbGeometryCollection) {
    for (const OGRGeometry* part : *geometry.toGeometryCollection()) for_each_line(*part, visit);
  }
}

Polyline plan_line(const OGRLineString& line, const Placement& placement) {
  Polyline result;
  for (int i = 0; i < line.getNumPoints(); ++i) {
    result.emplace_back(line.getX(i) - placement.north_west.east_m, placement.north_west.north_m - line.getY(i));
  }
  return result;
}

bool touches(const Polyline& line, const cv::Rect2d& area) {
  const auto [west, east] = std::ranges::minmax(line, {}, &PlanPoint::x);
  const auto [north, south] = std::ranges::minmax(line, {}, &PlanPoint::y);
  return east.x >= area.x && west.x <= area.x + area.width && south.y >= area.y && north.y <= area.y + area.height;
}

cv::Rect2d picture(const Placement& placement, double margin_m) {
  return {-margin_m, -margin_m, placement.cols * placement.gsd_m + 2.0 * margin_m,
          placement.rows * placement.gsd_m + 2.0 * margin_m};
}

}  // namespace

std::vector<Street> read_streets(const std::string& path, const Placement& placement) {
  const RoadRules rules;
  VectorFile file(path, {});
  const OGRSpatialReference plane = utm_reference(placement.zone);
  std::map<const OGRLayer*, TransformationPtr> to_plane;
  for (OGRLayer* layer : file.layers()) to_plane[layer] = transformation(file.crs_of(*layer), plane, path);
  const cv::Rect2d wanted = picture(placement, kSurroundingsM);
  std::vector<Street> streets;
  file.for_each_feature([&](OGRLayer& layer, OGRFeature& feature) {
    if (feature.GetGeometryRef() == nullptr || !to_plane.contains(&layer)) return;
    const TagLookup tags = [&](std::string_view key) { return tag_of(feature, key); };
    const bool classified = layer.GetLayerDefn()->GetFieldIndex(rules.class_attribute().c_str()) >= 0;
    const std::optional<double> width = rules.width_of(tags, classified);
    if (!width) return;
    const std::unique_ptr<OGRGeometry> geometry(feature.GetGeometryRef()->clone());
    if (geometry->transform(to_plane.at(&layer).get()) != OGRERR_NONE) return;
    const std::string road_class = classified ? tags(rules.class_attribute()) : "road";
    for_each_line(*geometry, [&](const OGRLineString& line) {
      Polyline points = plan_line(line, placement);
      if (points.size() >= 2 && touches(points, wanted)) streets.push_back({road_class, *width, std::move(points)});
    });
  });
  if (std::ranges::none_of(streets, [&](const Street& s) { return touches(s.line, picture(placement, 0.0)); })) {
    throw InvalidInput(
        "world-without-roads",
        fmt::format("{}: no road of it lies in the picture around the chosen centre; name a place inside "
                    "the file's extent with --center",
                    path));
  }
  sort_by_width(streets);
  return streets;
}

}  // namespace roadfix::world
