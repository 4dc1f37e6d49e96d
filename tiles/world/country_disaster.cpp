#include "tiles/world/country_disaster.hpp"

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tiles/world/corridor.hpp"
#include "tiles/world/disaster.hpp"
#include "tiles/world/farmsteads.hpp"
#include "tiles/world/palette.hpp"
#include "tiles/world/polygon.hpp"

namespace roadfix::world {
namespace {

/// Trees near streets lean towards the light and fall that way.
void fell_trees(Plan& plan, double share, Random& random) {
  Corridor streets(plan);
  streets.add(plan.streets, 0.0);
  const cv::Mat1f to_street = streets.distances();
  std::vector<Tree> standing;
  for (const Tree& tree : plan.trees) {
    const bool near = Corridor::at(to_street, tree.centre) < 0.8 * tree.height_m;
    if (tree.height_m < 6.0 || !random.chance(near ? share : 0.1 * share)) {
      standing.push_back(tree);
      continue;
    }
    const PlanPoint slope(
        Corridor::at(to_street, tree.centre + PlanPoint(2, 0)) - Corridor::at(to_street, tree.centre - PlanPoint(2, 0)),
        Corridor::at(to_street, tree.centre + PlanPoint(0, 2)) -
            Corridor::at(to_street, tree.centre - PlanPoint(0, 2)));
    const double angle = near ? std::atan2(-slope.y, -slope.x) + 0.5 * random.normal() : random.uniform(0.0, 6.28);
    const PlanPoint top = tree.centre + PlanPoint(std::cos(angle), std::sin(angle)) * tree.height_m;
    plan.country.logs.push_back({tree.centre, top, tree.radius_m, tree.leaf * tree.tone});
  }
  plan.trees = std::move(standing);
}

void slide(Plan& plan, Random& random) {
  const Street& street = plan.streets[random.index(plan.streets.size())];
  const PlanPoint off = offset(6.0, 6.0, random);
  const double radius_m = random.uniform(5.0, 22.0);
  Slide slide{blob(street.line[random.index(street.line.size())] + off, radius_m, random),
              palette::varied(plan.country.soil, 0.15, random), random.bits()};
  const std::vector<cv::Point2f> outline(slide.outline.begin(), slide.outline.end());
  std::erase_if(plan.trees, [&](const Tree& tree) {
    return cv::pointPolygonTest(outline, tree.centre, false) > 0.0 && random.chance(0.9);
  });
  plan.country.slides.push_back(std::move(slide));
}

}  // namespace

Plan after_earthquake_in_country(const Plan& before, double collapsed_share, Random& random) {
  Plan after = before;
  collapse(after, collapsed_share, random);
  fell_trees(after, random.uniform(0.3, 1.0) * (0.01 + 0.25 * collapsed_share), random);
  const int slides =
      static_cast<int>(std::lround(after.square_km() * (2.0 + 40.0 * collapsed_share) * random.uniform(0.3, 1.0)));
  for (int i = 0; i < slides && !after.streets.empty(); ++i) slide(after, random);
  after.boxes = country_traffic(after, random);
  return after;
}

}  // namespace roadfix::world
