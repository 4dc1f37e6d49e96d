#include "tiles/world/paint_streets.hpp"

#include "tiles/world/palette.hpp"
#include "tiles/world/random.hpp"
#include "tiles/world/site.hpp"

namespace roadfix::world {
namespace {

constexpr double kLargeM = 8.0;     // streets at least this wide have markings
constexpr double kDividedM = 13.0;  // and these a planted strip in the middle

/// Asphalt of one street. Ages differ: from nearly new, dark, to bleached; some small ones were never paved.
Colour asphalt_of(const Street& street, std::size_t number, const Conditions& conditions) {
  Random random(number, 29);
  Colour colour = palette::varied(palette::kAsphalt, 0.09, random);
  if (street.width_m >= kLargeM) colour *= 0.88;
  if (street.width_m < kLargeM && random.chance(0.12)) colour = palette::varied(palette::kSoil, 0.08, random) * 0.95;
  return palette::mixed(colour * conditions.asphalt, palette::kDust, conditions.dust);
}

void paint_middle(Canvas& canvas, const Street& street, const Colour& marking) {
  if (street.width_m >= kDividedM) {
    canvas.stroke(street.line, 2.4, palette::kSidewalk * 0.97, Material::kPaved);
    canvas.stroke(street.line, 1.2, palette::kGarden, Material::kGrass);
    return;
  }
  walk(street.line, 2.0, 9.0, [&](PlanPoint p, PlanPoint along) {
    canvas.stroke({p, p + along * 3.0}, 0.35, marking, Material::kAsphalt);
  });
}

/// Bars of a pedestrian crossing, across the street a few metres before its end.
void paint_crossing(Canvas& canvas, const Street& street, PlanPoint end, PlanPoint inward, const Colour& marking) {
  const PlanPoint across = perpendicular(inward);
  const PlanPoint middle = end + inward * 13.0;
  if (!canvas.sees(middle, street.width_m)) return;
  for (double v = -street.width_m / 2.0 + 0.8; v < street.width_m / 2.0 - 0.5; v += 1.3) {
    canvas.stroke({middle + across * v, middle + across * v + inward * 3.2}, 0.6, marking, Material::kAsphalt);
  }
}

}  // namespace

void paint_streets(Canvas& canvas, const Plan& plan, const Conditions& conditions) {
  const double dust = conditions.dust;
  const Colour sidewalk = palette::mixed(palette::kSidewalk, palette::kDust, dust);
  for (const Street& street : plan.streets) {
    if (street.surface != Surface::kKerbed) continue;
    canvas.stroke(street.line, street.width_m + 2.0 * sidewalk_m(street), sidewalk, Material::kPaved);
  }
  for (std::size_t i = 0; i < plan.streets.size(); ++i) {
    const Street& street = plan.streets[i];
    if (street.surface != Surface::kKerbed) continue;
    const Colour surface = asphalt_of(street, i, conditions);
    canvas.stroke(street.line, street.width_m, surface, Material::kAsphalt);
    // Tyres polish two tracks of each large street a little darker.
    if (street.width_m >= kLargeM)
      canvas.stroke(street.line, street.width_m * 0.62, surface * 0.955, Material::kAsphalt);
  }
  for (const Street& street : plan.streets) {
    if (street.surface != Surface::kKerbed || street.width_m < kLargeM || length_m(street.line) < 60.0) continue;
    const Colour marking = palette::mixed(palette::kMarking, palette::kDust, dust);
    paint_middle(canvas, street, marking);
    const std::size_t last = street.line.size() - 2;
    paint_crossing(canvas, street, street.line.front(), direction(street.line, 0), marking);
    paint_crossing(canvas, street, street.line.back(), -direction(street.line, last), marking);
  }
}

void paint_boxes(Canvas& canvas, const Plan& plan) {
  for (const Box& box : plan.boxes) {
    const Footprint& body = box.footprint;
    if (!canvas.sees(body.centre, body.radius_m())) continue;
    canvas.fill(body.corners(), box.colour, Material::kSmooth, box.height_m);
    const Footprint top{body.at(-0.1 * body.length_m, 0.0), body.angle_rad, body.length_m * 0.42, body.width_m * 0.82};
    canvas.fill(top.corners(), box.colour * 1.06, Material::kSmooth);
    const Footprint glass{body.at(0.2 * body.length_m, 0.0), body.angle_rad, body.length_m * 0.12, body.width_m * 0.8};
    if (box.height_m < 2.0) canvas.fill(glass.corners(), {52, 56, 62}, Material::kSmooth);
  }
}

}  // namespace roadfix::world
