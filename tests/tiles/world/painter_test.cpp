#include "tiles/world/painter.hpp"

#include <gmock/gmock.h>

#include "tiles/world/development.hpp"
#include "tiles/world/disaster.hpp"
#include "tiles/world/furnishing.hpp"
#include "tiles/world/street_network.hpp"

namespace roadfix::world {
namespace {

Plan town_after_earthquake() {
  Plan plan;
  plan.width_m = 300.0;
  plan.height_m = 300.0;
  Random random(4, 1);
  invent_streets(plan, random);
  Site site(plan);
  develop(plan, site, random);
  plant(plan, site, random);
  return after_earthquake(plan, site, 0.2, random);
}

TEST(Painter, LeavesNoSeamBetweenTiles) {
  const Plan plan = town_after_earthquake();
  const Texture texture(4);
  for (const Conditions& conditions : {summer_before(), winter_after()}) {
    const cv::Mat3b whole = paint_tile(plan, conditions, texture, {0, 0, 256, 256}, 1.0);
    for (const cv::Point corner : {cv::Point(0, 0), {128, 0}, {0, 128}, {128, 128}}) {
      const cv::Rect tile(corner, cv::Size(128, 128));
      const cv::Mat3b alone = paint_tile(plan, conditions, texture, tile, 1.0);
      EXPECT_LE(cv::norm(alone, whole(tile), cv::NORM_INF), 1.0) << corner;  // one grey level: rounding
    }
  }
}

TEST(Painter, DarkensWhatLiesBehindABuildingSeenFromTheSun) {
  Plan plan;
  plan.width_m = 128.0;
  plan.height_m = 128.0;
  plan.buildings.push_back({.footprint = {{64.0, 64.0}, 0.0, 20.0, 20.0},
                            .height_m = 20.0,
                            .roof = Roof::kFlat,
                            .roof_colour = {200, 200, 200},
                            .facade_colour = {180, 180, 180},
                            .lot_colour = {170, 160, 150},
                            .detail_seed = 1});
  Conditions low_sun = winter_after();
  low_sun.lean = {0.0, 0.0};
  const cv::Mat3b picture = paint_tile(plan, low_sun, Texture(1), {0, 0, 128, 128}, 1.0);
  const auto brightness = [&](PlanPoint p) {
    const cv::Rect around(cv::Point(static_cast<int>(p.x) - 2, static_cast<int>(p.y) - 2), cv::Size(5, 5));
    return cv::mean(picture(around))[1];
  };
  const PlanPoint middle(64.0, 64.0);
  EXPECT_LT(brightness(middle + low_sun.shadow_direction() * 28.0),
            0.7 * brightness(middle - low_sun.shadow_direction() * 28.0));
}

}  // namespace
}  // namespace roadfix::world
