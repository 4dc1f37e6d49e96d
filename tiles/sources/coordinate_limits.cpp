#include "tiles/sources/coordinate_limits.hpp"

#include <cmath>
#include <numbers>

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

}  // namespace roadfix
