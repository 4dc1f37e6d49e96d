#include "tiles/roads/road_geometry.hpp"

#include <algorithm>
#include <memory>

#include "tiles/roads/line_on_plane.hpp"

namespace roadfix {
namespace {

bool add_line(const OGRLineString& line, OGRCoordinateTransformation& to_plane, const Drawing& drawing,
              RoadNetwork& network) {
  constexpr double kLongestM = 2000.0;
  if (line.getNumPoints() < 2) return false;
  const auto points = line_on_plane(line, to_plane, kLongestM);
  if (!points) return false;
  network.lines.push_back({network.points.size(), points->size(), drawing.width_m / 2.0, drawing.road_class});
  network.points.insert(network.points.end(), points->begin(), points->end());
  return true;
}

}  // namespace

// The dimension of a collection is that of its largest part: it tells nothing of the lines beside an area.
bool holds_a_line(const OGRGeometry& geometry) {
  if (OGR_GT_IsSubClassOf(wkbFlatten(geometry.getGeometryType()), wkbGeometryCollection) == FALSE) {
    OGREnvelope box;
    geometry.getEnvelope(&box);
    return geometry.getDimension() == 1 && !(box.MinX == box.MaxX && box.MinY == box.MaxY);
  }
  const OGRGeometryCollection& parts = *geometry.toGeometryCollection();
  return std::any_of(parts.begin(), parts.end(), [](const OGRGeometry* part) { return holds_a_line(*part); });
}

bool add_geometry(const OGRGeometry& geometry, OGRCoordinateTransformation& to_plane, const Drawing& drawing,
                  RoadNetwork& network) {
  const OGRwkbGeometryType type = wkbFlatten(geometry.getGeometryType());
  if (type == wkbLineString) return add_line(*geometry.toLineString(), to_plane, drawing, network);
  if (OGR_GT_IsSubClassOf(type, wkbGeometryCollection) != FALSE) {
    bool any = false;
    for (const OGRGeometry* part : *geometry.toGeometryCollection()) {
      any = add_geometry(*part, to_plane, drawing, network) || any;
    }
    return any;
  }
  if (OGR_GT_IsCurve(type) != FALSE) {
    const std::unique_ptr<OGRGeometry> straight(geometry.getLinearGeometry());
    return straight && wkbFlatten(straight->getGeometryType()) == wkbLineString &&
           add_line(*straight->toLineString(), to_plane, drawing, network);
  }
  return false;
}

}  // namespace roadfix
