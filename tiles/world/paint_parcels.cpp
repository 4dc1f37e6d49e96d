#include "tiles/world/paint_parcels.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tiles/world/palette.hpp"
#include "tiles/world/polygon.hpp"
#include "tiles/world/random.hpp"

namespace roadfix::world {
namespace {

Material material_of(Cover cover) {
  switch (cover) {
    case Cover::kWood:
    case Cover::kMeadow:
    case Cover::kCrop:
      return Material::kGrass;
    case Cover::kScrub:
    case Cover::kPlough:
    case Cover::kStubble:
    case Cover::kOrchard:
      break;
  }
  return Material::kBare;
}

/// Parallel bands over a parcel.
struct Rows {
  double spacing_m = 3.0;
  double width_m = 1.2;
  double first_m = 0.0;
};

class ParcelPainter {
 public:
  ParcelPainter(Canvas& canvas, const Parcel& parcel, const Plan& plan, double winter)
      : canvas_(canvas),
        parcel_(parcel),
        soil_(plan.country.soil),
        random_(parcel.seed, 41),
        along_(std::cos(parcel.row_angle_rad), std::sin(parcel.row_angle_rad)),
        side_(perpendicular(along_)),
        colour_(palette::mixed(parcel.summer, parcel.winter, winter)) {}

  void paint() {
    canvas_.fill(parcel_.outline, colour_, material_of(parcel_.cover));
    switch (parcel_.cover) {
      case Cover::kWood:
        return;
      case Cover::kScrub:
        return blotches(160.0, 0.5);
      case Cover::kMeadow:
        blotches(700.0, 0.25);
        if (random_.chance(0.35)) swaths();
        if (random_.chance(0.2)) cattle_trail();
        return;
      case Cover::kOrchard:
        return draw({3.0, 1.0, 0.0}, colour_ * random_.uniform(0.85, 0.95));
      case Cover::kCrop:
      case Cover::kPlough:
      case Cover::kStubble:
        return field();
    }
  }

 private:
  void draw(const Rows& rows, const Colour& colour) {
    const PlanPoint middle = middle_of(parcel_.outline);
    const double reach = std::hypot(box_of(parcel_.outline).width, box_of(parcel_.outline).height) / 2.0 + 20.0;
    for (double across = -reach + rows.first_m; across < reach; across += rows.spacing_m) {
      for (const auto& [from, to] : stretches(parcel_.outline, middle + side_ * across, along_)) {
        const PlanPoint half = side_ * (rows.width_m / 2.0);
        canvas_.fill({from + half, to + half, to - half, from - half}, colour, material_of(parcel_.cover));
      }
    }
  }

  void field() {
    blotches(1500.0, 0.2);
    const double deep = parcel_.cover == Cover::kPlough ? random_.uniform(0.0, 0.16) : random_.uniform(0.0, 0.11);
    const double spacing = random_.chance(0.3) ? random_.uniform(3.5, 9.0) : random_.uniform(1.2, 3.0);
    const Colour furrow = colour_ * (1.0 + (random_.chance(0.5) ? deep : -deep));
    draw({spacing, spacing * random_.uniform(0.3, 0.55), 0.0}, furrow);
    if (parcel_.cover == Cover::kCrop ? random_.chance(0.7) : random_.chance(0.3)) tractor_marks();
  }

  /// A tractor always drives where it has driven before: pairs of wheel marks.
  void tractor_marks() {
    const double spacing = random_.uniform(10.0, 28.0);
    const double first = random_.uniform(0.0, spacing);
    const double width = random_.uniform(0.35, 0.6);
    const Colour mark = colour_ * 0.45 + soil_ * (random_.chance(0.6) ? 0.6 : 0.42);
    draw({spacing, width, first}, mark);
    draw({spacing, width, first + random_.uniform(1.7, 2.1)}, mark);
  }

  void swaths() {
    const double width = random_.uniform(3.0, 9.0);
    draw({2.0 * width, width, 0.0}, colour_ * random_.uniform(0.93, 1.09));
  }

  /// Growth is uneven: patches of thinner cover show the soil.
  void blotches(double m2_each, double strength) {
    const cv::Rect2d box = box_of(parcel_.outline);
    const std::vector<cv::Point2f> outline(parcel_.outline.begin(), parcel_.outline.end());
    const auto within = [&](const PlanPoint& p) { return cv::pointPolygonTest(outline, p, false) > 0.0; };
    const int count = static_cast<int>(box.area() / m2_each);
    for (int i = 0; i < count; ++i) {
      const PlanPoint at = any_point(box, random_);
      const Polyline patch = blob(at, random_.uniform(1.5, 7.0), random_);
      const double share = strength * random_.uniform(0.0, 0.6);
      const Colour tone = random_.chance(0.6) ? soil_ : colour_ * 0.6;
      if (std::ranges::all_of(patch, within))
        canvas_.fill(patch, palette::mixed(colour_, tone, share), material_of(parcel_.cover));
    }
  }

  void cattle_trail() {
    const cv::Rect2d box = box_of(parcel_.outline);
    const double angle = random_.uniform(0.0, 6.28);
    const PlanPoint heading(std::cos(angle), std::sin(angle));
    const PlanPoint middle = middle_of(parcel_.outline);
    Polyline trail;
    const double reach = 0.3 * std::min(box.width, box.height);
    for (double t = -reach; t < reach; t += 4.0) {
      trail.push_back(middle + heading * t + perpendicular(heading) * (4.0 * std::sin(t / 13.0)));
    }
    if (trail.size() > 1) canvas_.stroke(trail, 0.5, colour_ * 0.5 + soil_ * 0.52, Material::kBare);
  }

  Canvas& canvas_;
  const Parcel& parcel_;
  Colour soil_;
  Random random_;
  PlanPoint along_;
  PlanPoint side_;
  Colour colour_;
};

}  // namespace

void paint_parcels(Canvas& canvas, const Plan& plan, const Conditions& conditions) {
  for (const Parcel& parcel : plan.country.parcels) {
    if (canvas.sees(parcel.outline)) ParcelPainter(canvas, parcel, plan, conditions.winter).paint();
  }
  for (const Strip& strip : plan.country.strips) {
    canvas.stroke(strip.line, strip.width_m, strip.colour, Material::kGrass);
  }
  for (const Polyline& pond : plan.country.ponds) {
    canvas.fill(pond, plan.water, Material::kSmooth);
  }
}

}  // namespace roadfix::world
