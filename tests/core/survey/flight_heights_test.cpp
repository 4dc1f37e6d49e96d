#include "core/survey/flight_heights.hpp"

#include <gmock/gmock.h>

#include <cstdlib>
#include <memory>

#include "tests/core/survey/town_and_fields.hpp"
#include "tests/support/code_of.hpp"
#include "tests/support/sloping_ground.hpp"

namespace roadfix {
namespace {

using routes::PlannedHeight;
using testing::code_of;
using ::testing::HasSubstr;
using testing::message_of;
using enum routes::HeightAbove;

/// Of a map of 1200 m from west to east; its ground, where it is known, rises there from 200 to 260 m above the sea.
class FlightHeightsOver : public ::testing::Test {
 protected:
  FlightHeightsOver() { hills_.terrain = std::make_shared<const Terrain>(ground_.terrain()); }

  GridPoint at(double east_m) const { return {plain_.extent.min.east_m + east_m, plain_.extent.min.north_m + 400.0}; }
  /// From the west, where its home is, to a place so far east.
  routes::Route route(std::optional<PlannedHeight> from, std::optional<PlannedHeight> to, double to_east_m = 600.0) {
    const LatLon west = plain_.zone.unproject(at(0.0));
    return {{{west, from, "item 1"}, {plain_.zone.unproject(at(to_east_m)), to, "item 2"}}, {}, {west, std::nullopt}};
  }
  static std::optional<double> half_way(const MapView& map, const routes::Route& route, GridPoint point) {
    return FlightHeights(map, route, std::nullopt).agl_m(0, 0.5, point);
  }

  /// A ridge of 30 m half way to the east, on level ground.
  MapView ridge() const {
    Terrain terrain = ground_.terrain();
    const int crest = static_cast<int>(terrain.geometry.position_of(at(600.0)).col);
    for (std::size_t i = 0; i < terrain.codes.size(); ++i) {
      const int col = static_cast<int>(i) % terrain.geometry.cols;
      terrain.codes[i] = Terrain::code_of(std::abs(col - crest) <= 1 ? 230.0 : 200.0);
    }
    MapView map = plain_;
    map.terrain = std::make_shared<const Terrain>(terrain);
    return map;
  }

  MapView plain_ = testing::town_fields_and_unknown_ground();
  testing::SlopingGround ground_{{plain_.extent.min, {plain_.extent.min.east_m + 1200.0, plain_.extent.max.north_m}}};
  MapView hills_ = plain_;
};

constexpr double kStepM = 0.2;  // of stored heights

TEST_F(FlightHeightsOver, HillsAreThoseAboveTheSeaLessTheGround) {
  const auto level = route(PlannedHeight{500.0, kSea}, PlannedHeight{500.0, kSea});
  EXPECT_NEAR(half_way(hills_, level, at(300.0)).value(), 500.0 - 215.0, kStepM);
  const auto climb = route(PlannedHeight{400.0, kSea}, PlannedHeight{600.0, kSea});
  const FlightHeights heights(hills_, climb, std::nullopt);
  EXPECT_NEAR(heights.agl_m(0, 0.0, at(0.0)).value(), 400.0 - 200.0, kStepM);
  EXPECT_NEAR(heights.agl_m(0, 0.25, at(150.0)).value(), 450.0 - 207.5, kStepM);
  EXPECT_NEAR(heights.agl_m(0, 1.0, at(600.0)).value(), 600.0 - 230.0, kStepM);
  EXPECT_NEAR(half_way(hills_, route(PlannedHeight{210.0, kSea}, PlannedHeight{210.0, kSea}), at(300.0)).value(), -5.0,
              kStepM)
      << "into the ground";
}

TEST_F(FlightHeightsOver, HillsCountThoseAboveTheHomeFromItsGround) {
  auto level = route(PlannedHeight{100.0, kHome}, PlannedHeight{100.0, kHome});
  EXPECT_NEAR(half_way(hills_, level, at(300.0)).value(), 85.0, kStepM);
  level.home.above_sea_m = 700.0;
  EXPECT_NEAR(half_way(hills_, level, at(300.0)).value(), 85.0, kStepM) << "as the map knows it, whatever is planned";
  level.home.position = plain_.zone.unproject(at(-5000.0));
  EXPECT_NEAR(half_way(hills_, level, at(300.0)).value(), 585.0, kStepM) << "as it is planned, where the map does not";
  level.home.above_sea_m.reset();
  EXPECT_EQ(code_of([&] { FlightHeights(hills_, level, std::nullopt); }), "terrain-missing");
}

TEST_F(FlightHeightsOver, HillsFollowTheGroundBetweenPlacesThatDo) {
  const auto along = route(PlannedHeight{80.0, kGround}, PlannedHeight{120.0, kGround}, 1200.0);
  EXPECT_NEAR(half_way(ridge(), along, at(600.0)).value(), 100.0, 1e-9);
  const auto level = route(PlannedHeight{100.0, kHome}, PlannedHeight{100.0, kHome}, 1200.0);
  EXPECT_NEAR(half_way(ridge(), level, at(600.0)).value(), 70.0, kStepM) << "and others do not";
  const auto straight = route(PlannedHeight{80.0, kGround}, PlannedHeight{300.0, kSea}, 1200.0);
  EXPECT_NEAR(half_way(hills_, straight, at(600.0)).value(), (280.0 + 300.0) / 2.0 - 230.0, kStepM)
      << "and are straight between one and one that counts from the sea";
}

TEST_F(FlightHeightsOver, HillsAreUnknownWhereTheGroundIs) {
  const auto level = route(PlannedHeight{500.0, kSea}, PlannedHeight{500.0, kSea}, 8000.0);
  EXPECT_FALSE(half_way(hills_, level, at(4000.0)));
  const auto to_unknown = route(PlannedHeight{500.0, kSea}, PlannedHeight{100.0, kGround}, 8000.0);
  EXPECT_FALSE(half_way(hills_, to_unknown, at(300.0))) << "where it leads to a place above unknown ground";
}

TEST_F(FlightHeightsOver, UnknownGroundTakeItAsLevel) {
  const auto climb = route(PlannedHeight{0.0, kHome}, PlannedHeight{90.0, kGround});
  EXPECT_NEAR(half_way(plain_, climb, at(300.0)).value(), 45.0, 1e-9);
  const auto above_sea = route(PlannedHeight{50.0, kHome}, PlannedHeight{700.0, kSea});
  const auto refused = [&] { FlightHeights(plain_, above_sea, 100.0); };
  EXPECT_EQ(code_of(refused), "terrain-missing");
  EXPECT_THAT(message_of(refused), HasSubstr("item 2"));
  EXPECT_THAT(message_of(refused), HasSubstr("roadfix terrain"));
}

TEST_F(FlightHeightsOver, PlacesWithoutAnyAreRefusedByNameOrTakenAsUsual) {
  const auto untold = route(PlannedHeight{50.0, kGround}, std::nullopt);
  const auto refused = [&] { FlightHeights(plain_, untold, std::nullopt); };
  EXPECT_EQ(code_of(refused), "heights-missing");
  EXPECT_THAT(message_of(refused), HasSubstr("item 2"));
  EXPECT_NEAR(FlightHeights(plain_, untold, 150.0).agl_m(0, 0.5, at(300.0)).value(), 100.0, 1e-9);
}

TEST(DownwardCameras, ShowAsMuchGroundAsASquareOfTheirFootprint) {
  // Across 90 degrees from 100 m: 200 m, and 150 m along, of 4:3.
  const DownwardCamera wide{Angle::degrees(90.0)};
  EXPECT_NEAR(wide.footprint_m(100.0) * wide.footprint_m(100.0), 200.0 * 150.0, 1e-6);
  EXPECT_NEAR((DownwardCamera{Angle::degrees(60.0), 1.0}).footprint_m(300.0), 346.41, 0.01);
  EXPECT_EQ(wide.footprint_m(-5.0), 0.0);
}

}  // namespace
}  // namespace roadfix
