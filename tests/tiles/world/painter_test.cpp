#include "tiles/world/painter.hpp"

#include <gmock/gmock.h>

#include "tests/tiles/world/small_country.hpp"
#include "tiles/world/corridor.hpp"
#include "tiles/world/country_disaster.hpp"
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

Plan country_after_earthquake() {
  Random random(4, 1);
  return after_earthquake_in_country(testing::small_country(4, 300.0), 0.2, random);
}

void expect_no_seam_between_tiles(const Plan& plan) {
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

TEST(Painter, LeavesNoSeamBetweenTilesOfATown) { expect_no_seam_between_tiles(town_after_earthquake()); }

TEST(Painter, LeavesNoSeamBetweenTilesOfTheCountry) { expect_no_seam_between_tiles(country_after_earthquake()); }

/// With streets and without them: pixels differ on a road and its verge, nowhere else.
TEST(Painter, DrawsCountryRoadsWhereTheirLinesAre) {
  Plan with = testing::small_country(6, 320.0);
  with.trees.clear();
  Plan without = with;
  without.streets.clear();
  Conditions clear = summer_before();
  const Texture texture(6);
  const cv::Rect tile(0, 0, 320, 320);
  cv::Mat3b change;
  cv::absdiff(paint_tile(with, clear, texture, tile, 1.0), paint_tile(without, clear, texture, tile, 1.0), change);
  Corridor road(with);
  Corridor around(with);
  for (const Street& street : with.streets) {
    road.add(street.line, street.width_m - 1.0);
    around.add(street.line, street.width_m + 8.0);
  }
  int on_road = 0;
  int changed_on_road = 0;
  for (int row = 8; row < 312; ++row) {
    for (int col = 8; col < 312; ++col) {
      const PlanPoint p(col + 0.5, row + 0.5);
      const bool changed = cv::norm(change(row, col), cv::NORM_INF) > 4.0;
      EXPECT_TRUE(!changed || around.contains(p)) << p;
      if (!road.contains(p)) continue;
      ++on_road;
      changed_on_road += changed ? 1 : 0;
    }
  }
  EXPECT_GT(on_road, 500);
  EXPECT_GT(changed_on_road, 0.8 * on_road);
}

TEST(Painter, PaintsBareBranchesInWinterWhereLeavesWereInSummer) {
  Plan plan = testing::empty_country(128.0);
  plan.trees.push_back({.centre = {64, 64},
                        .radius_m = 6.0,
                        .height_m = 0.3,
                        .deciduous = true,
                        .crown = Crown::kBroadleaf,
                        .leaf = {30, 90, 30},
                        .autumn = {160, 110, 50}});
  const auto greenness = [&](double winter) {
    Conditions day = summer_before();
    day.winter = winter;
    const cv::Scalar mean = cv::mean(paint_tile(plan, day, Texture(1), {0, 0, 128, 128}, 1.0)(cv::Rect(60, 60, 8, 8)));
    return mean[1] - mean[0];
  };
  EXPECT_GT(greenness(0.0), 15.0);
  EXPECT_LT(greenness(0.6), 0.0);
  EXPECT_LT(greenness(1.0), 0.0);
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
