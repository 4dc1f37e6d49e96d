#include "tiles/world/paint_ground.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tiles/world/paint_crowns.hpp"
#include "tiles/world/paint_parcels.hpp"
#include "tiles/world/palette.hpp"
#include "tiles/world/polygon.hpp"
#include "tiles/world/random.hpp"

namespace roadfix::world {
namespace {

using palette::mixed;
using palette::varied;

struct Ground {
  Colour colour;
  Material material;
};

/// Ground of a block before anything stands on it. The same in both pictures but for the season.
Ground ground_of(LandUse use, double winter, Random& random) {
  const double draw = random.unit();
  const auto green = [&](const Colour& c) { return mixed(c, {118, 102, 76}, 0.55 * winter); };
  switch (use) {
    case LandUse::kPark:
      return {varied(green(palette::kLawn), 0.12, random), Material::kGrass};
    case LandUse::kForest:
      return {varied(green(palette::kGarden), 0.1, random), Material::kGrass};
    case LandUse::kHalls:
    case LandUse::kYard:
      return {varied(draw < 0.5 ? palette::kConcrete : palette::kGravel, 0.1, random), Material::kPaved};
    case LandUse::kWaste:
      return {varied(draw < 0.5 ? palette::kSoil : palette::kDryGrass, 0.12, random), Material::kBare};
    case LandUse::kOrchard:
      return {varied(draw < 0.6 ? palette::kRedSoil : palette::kSoil, 0.12, random), Material::kBare};
    case LandUse::kField:
      if (draw < 0.4) return {varied(palette::kStubble, 0.12, random), Material::kBare};
      if (draw < 0.7) return {varied(green(palette::kCrop), 0.15, random), Material::kGrass};
      return {varied(palette::kRedSoil, 0.15, random), Material::kBare};
    case LandUse::kVerge:
    case LandUse::kHouses:
    case LandUse::kApartments:
      break;
  }
  if (draw < 0.4) return {varied(palette::kGravel, 0.1, random), Material::kPaved};
  if (draw < 0.75) return {varied(palette::kSoil, 0.1, random), Material::kBare};
  return {varied(green(palette::kDryGrass), 0.12, random), Material::kBare};
}

/// Parcels of different crops, each with its furrows. They may reach over the block's rim: streets are painted later.
void paint_field(Canvas& canvas, const Block& block, double winter, Random& random) {
  const cv::Rect2d box = box_of(block.outline);
  const PlanPoint centre(box.x + box.width / 2.0, box.y + box.height / 2.0);
  const double reach = std::hypot(box.width, box.height) / 2.0;
  const double angle = random.uniform(0.0, 1.57);
  for (double u = -reach; u < reach;) {
    const double width = random.uniform(35.0, 90.0);
    for (double v = -reach; v < reach;) {
      const double length = random.uniform(60.0, 220.0);
      const Footprint grid{centre, angle, 0.0, 0.0};
      const Footprint parcel{grid.at(v + length / 2.0, u + width / 2.0), angle, length, width};
      const Ground surface = ground_of(LandUse::kField, winter, random);
      const Colour furrow = surface.colour * random.uniform(0.9, 0.96);
      const double spacing = random.uniform(3.0, 6.0);
      const bool inside = cv::pointPolygonTest(std::vector<cv::Point2f>(block.outline.begin(), block.outline.end()),
                                               parcel.centre, false) > 0;
      if (inside && canvas.sees(parcel.centre, parcel.radius_m())) {
        canvas.fill(parcel.corners(-0.6), surface.colour, surface.material);
        for (double w = -width / 2.0 + 2.0; w < width / 2.0 - 2.0; w += spacing) {
          const Footprint line{parcel.at(0.0, w), angle, length - 4.0, 1.2};
          canvas.fill(line.corners(), furrow, surface.material);
        }
      }
      v += length;
    }
    u += width;
  }
}

void paint_park(Canvas& canvas, const Block& block, Random& random) {
  const cv::Rect2d box = box_of(block.outline);
  const Colour path = varied(random.chance(0.5) ? palette::kRedSoil : palette::kSidewalk, 0.08, random);
  Polyline rim = block.outline;
  rim.push_back(rim.front());
  canvas.stroke(rim, 7.0, path, Material::kPaved);
  const PlanPoint centre(box.x + box.width / 2.0, box.y + box.height / 2.0);
  const double angle = random.uniform(0.0, 3.1);
  const PlanPoint ray = PlanPoint(std::cos(angle), std::sin(angle)) * (std::min(box.width, box.height) * 0.45);
  canvas.stroke({centre - ray, centre + ray}, 3.0, path, Material::kPaved);
  canvas.disc(centre, 6.0, path, Material::kPaved, 0.0);
}

/// What a lot around a building looks like; gardens of winter are brown.
void paint_lots(Canvas& canvas, const Plan& plan, double winter) {
  for (const Building& building : plan.buildings) {
    if (!canvas.sees(building.footprint.centre, building.footprint.radius_m() + 6.0)) continue;
    const bool green = building.lot_colour[1] > building.lot_colour[0];
    const Colour colour = green ? mixed(building.lot_colour, palette::kDryGrass, 0.5 * winter) : building.lot_colour;
    canvas.fill(building.footprint.corners(2.8), colour, green ? Material::kGrass : Material::kPaved);
  }
}

}  // namespace

void paint_ground(Canvas& canvas, const Plan& plan, const Conditions& conditions) {
  canvas.fill(Polyline{{-200, -200},
                       {plan.width_m + 200, -200},
                       {plan.width_m + 200, plan.height_m + 200},
                       {-200, plan.height_m + 200}},
              palette::kSoil, Material::kBare);
  paint_parcels(canvas, plan, conditions);
  for (std::size_t i = 0; i < plan.blocks.size(); ++i) {
    const Block& block = plan.blocks[i];
    if (block.outline.size() < 3 || !canvas.sees(block.outline)) continue;
    Random random(i, 17);
    const Ground surface = ground_of(block.use, conditions.winter, random);
    canvas.fill(block.outline, surface.colour, surface.material);
    if (block.use == LandUse::kField) paint_field(canvas, block, conditions.winter, random);
    if (block.use == LandUse::kPark) paint_park(canvas, block, random);
  }
  paint_lots(canvas, plan, conditions.winter);
  if (!plan.river.empty()) {
    canvas.stroke(plan.river, plan.river_width_m * 1.45, palette::kGarden, Material::kGrass);
    canvas.stroke(plan.river, plan.river_width_m, plan.water, Material::kSmooth);
  }
}

void paint_trees(Canvas& canvas, const Plan& plan, const Conditions& conditions) {
  const PlanPoint to_sun = -conditions.shadow_direction();
  for (const Tree& tree : plan.trees) {
    if (!canvas.sees(tree.centre, tree.radius_m + 2.0)) continue;
    if (tree.crown != Crown::kGarden) {
      paint_crown(canvas, tree, conditions);
      continue;
    }
    const PlanPoint crown = tree.centre + conditions.lean * (tree.height_m * 0.6);
    const bool bare = tree.deciduous && conditions.winter > 0.5;
    const Colour colour = (bare ? palette::kBareTree : palette::kTree) * tree.tone;
    const double radius = bare ? tree.radius_m * 0.75 : tree.radius_m;
    canvas.disc(crown, radius, colour * 0.8, Material::kLeaves, tree.height_m);
    canvas.disc(crown + to_sun * (radius * 0.28), radius * 0.62, colour * 1.15, Material::kLeaves, tree.height_m);
  }
}

void paint_debris(Canvas& canvas, const Plan& plan) {
  constexpr double kChunkM2 = 2.2;
  for (const Debris& debris : plan.debris) {
    const Footprint& heap = debris.footprint;
    Random random(debris.seed, 3);
    if (!canvas.sees(heap.centre, heap.radius_m() + 12.0)) continue;
    const Colour tone = varied(palette::kRubble, 0.12, random);
    canvas.fill(heap.corners(-1.0), tone * 0.9, Material::kRubble, debris.height_m * 0.4);
    const int chunks = static_cast<int>(heap.length_m * heap.width_m / kChunkM2);
    for (int i = 0; i < chunks; ++i) {
      const double u = std::clamp(random.normal() * 0.30, -0.75, 0.75);
      const double v = std::clamp(random.normal() * 0.30, -0.75, 0.75);
      const Footprint chunk{heap.at(u * heap.length_m, v * heap.width_m), random.uniform(0.0, 3.1),
                            random.uniform(0.7, 3.6), random.uniform(0.5, 2.2)};
      const double top = debris.height_m * random.uniform(0.15, 1.0) * (1.0 - 0.8 * std::max(std::abs(u), std::abs(v)));
      Colour colour = tone * random.uniform(0.62, 1.2);
      if (random.chance(0.04)) colour = varied({150, 104, 84}, 0.2, random);
      canvas.fill(chunk.corners(), colour, Material::kRubble, top);
    }
  }
}

}  // namespace roadfix::world
