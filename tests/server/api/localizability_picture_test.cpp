#include "server/api/localizability_picture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <set>
#include <utility>

namespace roadfix::api {
namespace {

constexpr double kFootprintM = 400.0;

/// 8 x 8 km on the Equator, where a tile of zoom 15 is 1223 m wide. Nobody reads its cells.
MapView wide_map() {
  return {"city", "v1", *UtmZone::from_epsg(32637), 2.0, {{496'000, 100'000}, {504'000, 108'000}}, 0.0, {}};
}

TileAddress tile_of(const MapView& map, GridPoint at, int zoom) {
  const MercatorPixel p = mercator_pixel(map.zone.unproject(at), zoom);
  return {zoom, static_cast<int>(p.x / kTilePixels), static_cast<int>(p.y / kTilePixels)};
}

using Places = std::set<std::pair<double, double>>;

Places places_of(const MapView& map, TileAddress tile) {
  Places places;
  localizability_png(map, tile, kFootprintM, TileStyle::kColour, [&](GridPoint place) {
    EXPECT_TRUE(places.emplace(place.east_m, place.north_m).second) << "asked for twice";
    return std::optional(1.0);
  });
  return places;
}

TEST(LocalizabilityPicture, AsksForAFewPlacesOfATileWhateverTheZoom) {
  const MapView map = wide_map();
  const ZoomRange zooms = localizability_zooms(map, kFootprintM);
  for (int zoom = zooms.first; zoom <= zooms.last + 3; ++zoom) {
    const Places places = places_of(map, tile_of(map, {500'100, 104'100}, zoom));
    EXPECT_GE(places.size(), 1U) << zoom;
    EXPECT_LE(places.size(), std::size_t{(kSquaresAcross + 2) * (kSquaresAcross + 2)}) << zoom;
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
  const TileAddress coarse = tile_of(map, {500'100, 104'100}, 14);
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
  const auto east_only = [](GridPoint place) { return place.east_m > 496'500 ? std::optional(1.0) : std::nullopt; };
  const TileAddress corner = tile_of(map, {497'000, 100'200}, 15);
  const auto png = localizability_png(map, corner, kFootprintM, TileStyle::kGrey, east_only);
  ASSERT_TRUE(png);
  const cv::Mat picture = cv::imdecode(*png, cv::IMREAD_UNCHANGED);
  ASSERT_EQ(picture.size(), cv::Size(kTilePixels, kTilePixels));
  for (int y = 0; y < kTilePixels; ++y) {
    for (int x = 0; x < kTilePixels; ++x) {
      if (picture.at<cv::Vec4b>(y, x)[3] == 0) continue;
      const GridPoint ground =
          map.zone.project(lat_lon({kTilePixels * corner.x + x + 0.5, kTilePixels * corner.y + y + 0.5}, corner.z));
      EXPECT_GT(ground.east_m, 496'500 - 0.5 * 400.0);
      EXPECT_GT(ground.north_m, 100'000 - 1.0);
      EXPECT_EQ(picture.at<cv::Vec4b>(y, x)[0], 255);
    }
  }
  EXPECT_FALSE(localizability_png(map, corner, kFootprintM, TileStyle::kGrey,
                                  [](GridPoint) { return std::optional<double>(); }));
  EXPECT_FALSE(localizability_png(map, {15, 0, 0}, kFootprintM, TileStyle::kGrey, east_only));
}

TEST(LocalizabilityPicture, GoesFromRedOverYellowToGreen) {
  const MapView map = wide_map();
  const auto colour_of = [&](double probability) {
    const auto png = localizability_png(map, tile_of(map, {500'100, 104'100}, 17), kFootprintM, TileStyle::kColour,
                                        [&](GridPoint) { return std::optional(probability); });
    return cv::imdecode(*png, cv::IMREAD_UNCHANGED).at<cv::Vec4b>(100, 100);
  };
  EXPECT_EQ(colour_of(0.0), cv::Vec4b(130, 139, 242, 128));
  EXPECT_EQ(colour_of(0.5), cv::Vec4b(93, 201, 244, 128));
  EXPECT_EQ(colour_of(1.0), cv::Vec4b(161, 224, 126, 128));
}

}  // namespace
}  // namespace roadfix::api
