#include "server/api/localizability_picture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "tests/support/decoded_png.hpp"

namespace roadfix::api {
namespace {

constexpr double kFootprintM = 400.0;

/// 8 x 8 km on the Equator, where a tile of zoom 15 is 1223 m wide. Nobody reads its cells.
MapView wide_map() {
  return {{"city", "v1"}, *UtmZone::from_epsg(32637), 2.0, {{496'000, 100'000}, {504'000, 108'000}}, {}, {}, {}};
}

mercator::TileAddress tile_of(const MapView& map, GridPoint at, int zoom) {
  const mercator::MercatorPixel p = mercator::mercator_pixel(map.zone.unproject(at), zoom);
  return {zoom, static_cast<int>(p.x / mercator::kTilePixels), static_cast<int>(p.y / mercator::kTilePixels)};
}

constexpr PlaceAnswer kFix{true, 1.0};

using Places = std::set<std::pair<double, double>>;

Places places_of(const MapView& map, mercator::TileAddress tile) {
  Places places;
  localizability_png(map, tile, kFootprintM, mercator::TileStyle::kColour, [&](GridPoint place) {
    EXPECT_TRUE(places.emplace(place.east_m, place.north_m).second) << "asked for twice";
    return std::optional(kFix);
  });
  return places;
}

TEST(LocalizabilityPicture, AsksForAFewPlacesOfATileWhateverTheZoom) {
  constexpr std::size_t kMostAcross = kSquaresAcross + 2;
  const MapView map = wide_map();
  const ZoomRange zooms = localizability_zooms(map, kFootprintM);
  for (int zoom = zooms.first; zoom <= zooms.last + 3; ++zoom) {
    const Places places = places_of(map, tile_of(map, {500'100, 104'100}, zoom));
    EXPECT_GE(places.size(), 1U) << zoom;
    EXPECT_LE(places.size(), kMostAcross * kMostAcross) << zoom;
  }
}

TEST(LocalizabilityPicture, DrawsNothingWhereAPlaceWouldSpeakForTooMuchGround) {
  const MapView map = wide_map();
  const int coarse = localizability_zooms(map, kFootprintM).first - 1;
  EXPECT_FALSE(square_m(map, coarse, kFootprintM));
  EXPECT_TRUE(places_of(map, tile_of(map, {500'100, 104'100}, coarse)).empty());
  EXPECT_EQ(square_m(map, coarse + 1, kFootprintM), 4.0 * kFootprintM);
  EXPECT_EQ(square_m(map, localizability_zooms(map, kFootprintM).last, kFootprintM), 0.5 * kFootprintM);
}

TEST(LocalizabilityPicture, FindsThePlacesOfACoarseZoomAmongThoseOfAFineOne) {
  const MapView map = wide_map();
  const mercator::TileAddress coarse = tile_of(map, {500'100, 104'100}, 14);
  Places fine;
  for (const int dx : {-1, 0, 1, 2}) {
    for (const int dy : {-1, 0, 1, 2}) fine.merge(places_of(map, {15, 2 * coarse.x + dx, 2 * coarse.y + dy}));
  }
  const Places places = places_of(map, coarse);
  EXPECT_FALSE(places.empty());
  EXPECT_TRUE(std::ranges::includes(fine, places));
}

TEST(LocalizabilityPicture, LeavesOutWhatIsOffTheMapAndWhatCannotBeSaid) {
  const MapView map = wide_map();
  const auto east_only = [](GridPoint place) { return place.east_m > 496'500 ? std::optional(kFix) : std::nullopt; };
  const mercator::TileAddress corner = tile_of(map, {497'000, 100'200}, 15);
  const auto png = localizability_png(map, corner, kFootprintM, mercator::TileStyle::kGrey, east_only);
  ASSERT_TRUE(png);
  const cv::Mat picture = testing::decoded_png(*png);
  ASSERT_EQ(picture.size(), cv::Size(mercator::kTilePixels, mercator::kTilePixels));
  for (int y = 0; y < mercator::kTilePixels; ++y) {
    for (int x = 0; x < mercator::kTilePixels; ++x) {
      if (picture.at<cv::Vec4b>(y, x)[3] == 0) continue;
      const GridPoint ground = map.zone.project(mercator::lat_lon(
          {mercator::kTilePixels * corner.x + x + 0.5, mercator::kTilePixels * corner.y + y + 0.5}, corner.z));
      EXPECT_GT(ground.east_m, 496'500 - 0.5 * 400.0);
      EXPECT_GT(ground.north_m, 100'000 - 1.0);
      ASSERT_EQ(picture.at<cv::Vec4b>(y, x)[0], 255);
    }
  }
  EXPECT_FALSE(localizability_png(map, corner, kFootprintM, mercator::TileStyle::kGrey,
                                  [](GridPoint) { return std::optional<PlaceAnswer>(); }));
  EXPECT_FALSE(localizability_png(map, {15, 0, 0}, kFootprintM, mercator::TileStyle::kGrey, east_only));
}

TEST(LocalizabilityPicture, IsGreenForAFixAloneAndAtMostYellowBelow) {
  const MapView map = wide_map();
  const auto colour_of = [&](PlaceAnswer answer) {
    const auto png = localizability_png(map, tile_of(map, {500'100, 104'100}, 17), kFootprintM,
                                        mercator::TileStyle::kColour, [&](GridPoint) { return std::optional(answer); });
    return testing::decoded_png(*png).at<cv::Vec4b>(100, 100);
  };
  const cv::Vec4b red(37, 48, 217, 128);
  const cv::Vec4b yellow(93, 201, 244, 128);
  const cv::Vec4b green(161, 224, 126, 128);
  EXPECT_EQ(colour_of({false, 0.0}), red);
  EXPECT_EQ(colour_of({false, 0.5}), cv::Vec4b(65, 125, 231, 128)) << "in between";
  EXPECT_EQ(colour_of({false, 1.0}), yellow) << "sure, and yet no fix";
  EXPECT_EQ(colour_of({true, 0.991}), green);
  EXPECT_EQ(colour_of({true, 1.0}), green);
}

}  // namespace
}  // namespace roadfix::api
