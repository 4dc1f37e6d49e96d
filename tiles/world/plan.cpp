#include "tiles/world/plan.hpp"

#include <algorithm>
#include <cmath>

namespace roadfix::world {

PlanPoint Footprint::at(double along_m, double across_m) const {
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  return centre + PlanPoint(c * along_m - s * across_m, s * along_m + c * across_m);
}

Polyline Footprint::corners(double margin_m) const {
  const double a = length_m / 2.0 + margin_m;
  const double b = width_m / 2.0 + margin_m;
  return {at(-a, -b), at(a, -b), at(a, b), at(-a, b)};
}

double Footprint::radius_m() const { return std::hypot(length_m, width_m) / 2.0; }

double length_m(const Polyline& line) {
  double sum = 0.0;
  for (std::size_t i = 1; i < line.size(); ++i) sum += cv::norm(line[i] - line[i - 1]);
  return sum;
}

PlanPoint direction(const Polyline& line, std::size_t index) {
  const PlanPoint step = line[index + 1] - line[index];
  const double length = cv::norm(step);
  return length > 0.0 ? step / length : PlanPoint(1.0, 0.0);
}

PlanPoint beside(const Polyline& line, std::size_t index, double off_m) {
  return line[index] + perpendicular(direction(line, std::min(index, line.size() - 2))) * off_m;
}

void walk(const Polyline& line, double start_m, double step_m, const std::function<void(PlanPoint, PlanPoint)>& visit) {
  double next = start_m;
  double before = 0.0;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const double length = cv::norm(line[i + 1] - line[i]);
    const PlanPoint along = direction(line, i);
    for (; next <= before + length; next += step_m) visit(line[i] + along * (next - before), along);
    before += length;
  }
}

}  // namespace roadfix::world
