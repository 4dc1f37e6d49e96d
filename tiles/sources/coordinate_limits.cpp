#include "tiles/sources/coordinate_limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "core/units/error.hpp"
#include "tiles/sources/gdal_session.hpp"

namespace roadfix {
namespace {

class CornersHeld final : public OGRDefaultConstGeometryVisitor {
 public:
  explicit CornersHeld(CoordinateLimits limits) : limits_(limits) {}

  using OGRDefaultConstGeometryVisitor::visit;
  void visit(const OGRLineString* line) override { look_at(*line); }
  void visit(const OGRCircularString* arcs) override { look_at(*arcs); }
  bool all() const { return all_; }

 private:
  void look_at(const OGRSimpleCurve& curve) {
    for (int i = 0; i < curve.getNumPoints(); ++i) {
      all_ = all_ && std::abs(curve.getX(i)) <= limits_.x && std::abs(curve.getY(i)) <= limits_.y;
    }
  }

  CoordinateLimits limits_;
  bool all_ = true;
};

/// In degrees, its east beyond its west. Of those that the WKT of a .prj file describes, without codes, of UTM zones
/// only.
std::optional<OGREnvelope> area_of_use(const OGRSpatialReference& crs) {
  OGREnvelope area;
  if (!crs.GetAreaOfUse(&area.MinX, &area.MinY, &area.MaxX, &area.MaxY, nullptr)) {
    int northern = FALSE;
    const int zone = crs.GetUTMZone(&northern);
    if (zone == 0) return std::nullopt;
    area.Merge(6 * zone - 186, northern != FALSE ? 0.0 : -80.0);
    area.Merge(6 * zone - 180, northern != FALSE ? 84.0 : 0.0);
  }
  if (area.MaxX < area.MinX) area.MaxX += 360.0;
  return area;
}

/// From the middle of an area, in widths or heights of it, whichever are more: 0.5 at its rim.
double away_from(const OGREnvelope& area, double lon, double lat) {
  const double east = std::remainder(lon - (area.MinX + area.MaxX) / 2.0, 360.0);
  const double north = lat - (area.MinY + area.MaxY) / 2.0;
  return std::max(std::abs(east) / (area.MaxX - area.MinX), std::abs(north) / (area.MaxY - area.MinY));
}

}  // namespace

bool CoordinateLimits::hold(const OGREnvelope& box) const {
  return box.MinX >= -x && box.MaxX <= x && box.MinY >= -y && box.MaxY <= y;
}

bool CoordinateLimits::hold(const OGRGeometry& geometry) const {
  CornersHeld corners(*this);
  geometry.accept(&corners);
  return corners.all();
}

CoordinateLimits coordinate_limits(const OGRSpatialReference& crs) {
  constexpr double kRounding = 1.0 + 1e-9;
  constexpr double kPlaneM = 1e9;
  if (crs.IsGeographic() == FALSE) return {kPlaneM / crs.GetLinearUnits(), kPlaneM / crs.GetLinearUnits()};
  const double turn = 2.0 * std::numbers::pi / crs.GetAngularUnits() * kRounding;
  return {turn, turn / 4.0};
}

void refuse_degrees_as_metres(const OGREnvelope& box, const OGRSpatialReference& crs, const std::string& path) {
  constexpr CoordinateLimits kDegrees{360.0, 90.0};
  if (!kDegrees.hold(box) || crs.IsProjected() == FALSE) return;
  throw InvalidInput("degrees-as-metres",
                     fmt::format("{}: its reference system {} has metres or feet, but its coordinates, {} {} to {} {}, "
                                 "look like degrees: give --crs EPSG:4326",
                                 path, crs_name(crs), box.MinX, box.MinY, box.MaxX, box.MaxY));
}

void refuse_swapped_axes(const OGREnvelope& box, const OGRSpatialReference& crs, const std::string& path) {
  if (crs.IsProjected() == FALSE) return;
  const std::optional<OGREnvelope> area = area_of_use(crs);
  if (!area) return;
  const TransformationPtr to_earth = transformation(crs, wgs84_reference(), path);
  const GdalMessages messages;
  const auto away = [&](double x, double y) {
    const bool on_earth = to_earth->Transform(1, &x, &y) != FALSE && std::isfinite(x) && std::isfinite(y);
    return on_earth ? away_from(*area, x, y) : std::numeric_limits<double>::infinity();
  };
  const double x = (box.MinX + box.MaxX) / 2.0;
  const double y = (box.MinY + box.MaxY) / 2.0;
  if (away(x, y) <= 1.5 || away(y, x) > 0.5) return;
  throw InvalidInput(
      "axes-swapped",
      fmt::format("{}: its coordinates, {:.1f} {:.1f} to {:.1f} {:.1f}, lie far from the ground that its "
                  "reference system {} is for, and in it with easting and northing swapped: write the "
                  "easting first, in a world file in the line before the last one, or give the right "
                  "reference system with --crs of ingest",
                  path, box.MinX, box.MinY, box.MaxX, box.MaxY, crs_name(crs)));
}

}  // namespace roadfix
