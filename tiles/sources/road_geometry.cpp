#include "tiles/sources/road_geometry.hpp"

#include <cmath>
#include <memory>
#include <vector>

namespace roadfix {
namespace {

bool add_line(const OGRLineString& line, OGRCoordinateTransformation& to_plane, const Drawing& drawing,
              RoadNetwork& network) {
  const int count = line.getNumPoints();
  if (count < 2) return false;
  std::vector<double> x(static_cast<std::size_t>(count));
  std::vector<double> y(x.size());
  std::vector<int> good(x.size(), FALSE);
  for (int i = 0; i < count; ++i) {
    x[static_cast<std::size_t>(i)] = line.getX(i);
    y[static_cast<std::size_t>(i)] = line.getY(i);
  }
  to_plane.Transform(count, x.data(), y.data(), nullptr, good.data());
  const std::size_t first = network.points.size();
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (good[i] == FALSE || !std::isfinite(x[i]) || !std::isfinite(y[i])) {
      network.points.resize(first);
      return false;
    }
    network.points.push_back({x[i], y[i]});
  }
  network.lines.push_back({first, x.size(), drawing.width_m / 2.0, drawing.road_class});
  return true;
}

}  // namespace

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
