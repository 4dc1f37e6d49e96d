#include "tiles/sources/coordinate_limits.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

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

}  // namespace roadfix
