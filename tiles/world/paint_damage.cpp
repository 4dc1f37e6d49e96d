#include "tiles/world/paint_damage.hpp"

#include <cmath>

#include "tiles/world/palette.hpp"
#include "tiles/world/polygon.hpp"
#include "tiles/world/random.hpp"

namespace roadfix::world {

void paint_slides(Canvas& canvas, const Countryside& country) {
  constexpr double kStoneM2 = 9.0;
  for (const Slide& slide : country.slides) {
    const cv::Rect2d box = box_of(slide.outline);
    const PlanPoint middle = middle_of(slide.outline);
    if (!canvas.sees(middle, std::hypot(box.width, box.height) / 2.0 + 3.0)) continue;
    Random random(slide.seed, 5);
    canvas.fill(slide.outline, slide.colour, Material::kRubble);
    const int stones = static_cast<int>(box.area() / kStoneM2);
    for (int i = 0; i < stones; ++i) {
      const PlanPoint at = middle + offset(0.24 * box.width, 0.24 * box.height, random);
      const Polyline clod = blob(at, random.uniform(0.4, 2.6), random);
      const double height_m = random.uniform(0.2, 1.6);
      canvas.fill(clod, slide.colour * random.uniform(0.7, 1.25), Material::kRubble, height_m);
    }
  }
}

void paint_logs(Canvas& canvas, const Countryside& country, const Conditions& conditions) {
  constexpr double kTrunkM = 0.6;
  for (const Log& log : country.logs) {
    const PlanPoint way = log.top - log.foot;
    if (!canvas.sees((log.foot + log.top) / 2.0, cv::norm(way) / 2.0 + log.crown_m)) continue;
    Random random(static_cast<std::uint64_t>((log.foot.x + 1e4) * 64.0), 7);
    const Colour leaf = palette::mixed(log.leaf, palette::kBareTree, 0.5 * conditions.winter);
    canvas.disc(log.foot, 1.1, palette::kSoil * 0.8, Material::kBare, 0.5);  // the plate of its roots
    const int tufts = static_cast<int>(6.0 + 3.0 * log.crown_m);
    for (int i = 0; i < tufts; ++i) {
      const double along = random.uniform(0.4, 1.0);
      const double wide = log.crown_m * 0.75 * (1.25 - along);
      const PlanPoint at = log.foot + way * along + offset(wide, wide, random);
      const double height_m = random.uniform(0.5, 2.0);
      const Colour tone = leaf * random.uniform(0.7, 1.3);
      canvas.disc(at, random.uniform(0.3, 0.9), tone, Material::kLeaves, height_m);
    }
    canvas.stroke({log.foot, log.foot + way * 0.8}, kTrunkM, Colour(128, 112, 92) * random.uniform(0.75, 1.2),
                  Material::kBare);
  }
}

}  // namespace roadfix::world
