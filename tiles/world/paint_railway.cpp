#include "tiles/world/paint_railway.hpp"

#include "tiles/world/palette.hpp"
#include "tiles/world/random.hpp"

namespace roadfix::world {
namespace {

constexpr double kGaugeM = 1.435;

Polyline moved_aside(const Polyline& line, double off_m) {
  Polyline result;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    result.push_back(beside(line, i, off_m));
  }
  return result;
}

}  // namespace

void paint_railway(Canvas& canvas, const Countryside& country, const Conditions& conditions) {
  if (country.railway.empty()) return;
  Random random(country.railway.size(), 43);
  const double rust = random.uniform(0.0, 1.0);
  const Colour ballast = palette::varied(palette::mixed({150, 142, 134}, {134, 108, 90}, rust), 0.12, random);
  const Colour verge = country.grass * 0.75 + country.soil * 0.25;
  canvas.stroke(country.railway, random.uniform(7.0, 10.0), verge, Material::kGrass);
  canvas.stroke(country.railway, random.uniform(3.6, 4.6), ballast, Material::kBare);
  const Colour sleeper = ballast * (random.chance(0.5) ? 0.78 : 1.12);
  canvas.stroke(country.railway, 2.4, ballast * 0.5 + sleeper * 0.5, Material::kBare);
  walk(country.railway, 0.0, 1.8, [&](PlanPoint p, PlanPoint along) {
    const PlanPoint half = perpendicular(along) * 1.2;
    if (canvas.sees(p, 2.0)) canvas.stroke({p - half, p + half}, 0.5, sleeper, Material::kBare);
  });
  const Colour rail = Colour(112, 100, 92) * (1.0 - 0.4 * conditions.dust) * (random.chance(0.5) ? 0.7 : 1.45);
  for (const double side : {-1.0, 1.0}) {
    canvas.stroke(moved_aside(country.railway, side * kGaugeM / 2.0), 0.22, rail, Material::kSmooth);
  }
}

}  // namespace roadfix::world
