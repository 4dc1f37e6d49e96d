#include "tiles/mercator/tile_picture.hpp"

#include <gtest/gtest.h>

#include "core/grid/resample.hpp"
#include "tests/support/decoded_png.hpp"
#include "tiles/mercator/tile_ground.hpp"

namespace roadfix::mercator {
namespace {

/// A square of 1 km: roads where (col + row) of the 2 m lattice makes broad diagonal stripes, its west unobserved.
Cell cell_at(int col, int row) {
  if (col < 217100) return kUnobserved;
  return ((col + row) % 40 + 40) % 40 < 8 ? kRoad : kNoRoad;
}

MapView striped_map() {
  const GridGeometry whole{2.0, {217000, -2090000}, 500, 500};
  const auto read = [whole](const GridGeometry& asked) {
    const double factor = asked.cell_m / 2.0;
    RoadGrid part = RoadGrid::unobserved(asked);
    for (int row = 0; row < asked.rows; ++row) {
      for (int col = 0; col < asked.cols; ++col) {
        const auto p = whole.position_of(asked.cell_center(col, row));
        if (p.col < 0 || p.row < 0 || p.col >= 500 || p.row >= 500) continue;
        part.cells.at(col, row) =
            factor > 1.5 ? kRoad : cell_at(217000 + static_cast<int>(p.col), -2090000 + static_cast<int>(p.row));
      }
    }
    return part;
  };
  return {{"city", "v1"}, *UtmZone::from_epsg(32637), 2.0, whole.box(), {}, {}, read};
}

TileAddress tile_of(LatLon at, int zoom) {
  const MercatorPixel p = mercator_pixel(at, zoom);
  return {zoom, static_cast<int>(p.x / kTilePixels), static_cast<int>(p.y / kTilePixels)};
}

TEST(WebMercator, GivesPublishedTileNumbers) {
  // OpenStreetMap wiki, "Slippy map tilenames": the Brandenburg Gate.
  const TileAddress tile = tile_of({52.516275, 13.377704}, 17);
  EXPECT_EQ(tile.x, 70406);
  EXPECT_EQ(tile.y, 42987);
  const LatLon back = lat_lon(mercator_pixel({-33.9, 151.2}, 20), 20);
  EXPECT_NEAR(back.lat_deg, -33.9, 1e-9);
  EXPECT_NEAR(back.lon_deg, 151.2, 1e-9);
}

TEST(TouchedPixels, OfAMapAcrossTheAntimeridianLieOnBothSides) {
  const UtmZone fiji = *UtmZone::from_epsg(32701);
  const GridPoint middle = fiji.project({-16.9, 180.0});
  MapView map = striped_map();
  map.zone = fiji;
  map.extent = {{middle.east_m - 1000.0, middle.north_m - 1000.0}, {middle.east_m + 1000.0, middle.north_m + 1000.0}};
  for (const int zoom : {2, 10, 14}) {
    for (const double lon : {179.995, -179.995}) {
      const PixelBox box = touched_pixels(map, tile_of({-16.9, lon}, zoom));
      ASSERT_FALSE(box.empty()) << zoom << ' ' << lon;
      EXPECT_NO_THROW(PixelToGrid(fiji, tile_of({-16.9, lon}, zoom), box)) << zoom << ' ' << lon;
    }
    EXPECT_TRUE(touched_pixels(map, tile_of({-16.9, 0.0}, zoom)).empty());
  }
  const TileAddress world{0, 0, 0};
  EXPECT_NO_THROW(PixelToGrid(fiji, world, touched_pixels(map, world)));
}

TEST(TilePicture, ShowsEveryPixelWhatTheExactProjectionFindsThere) {
  const MapView map = striped_map();
  const LatLon centre = map.zone.unproject({434500.0, 4179500.0});
  const TileAddress tile = tile_of(centre, 18);
  const auto png = tile_png(map, tile, TileStyle::kGrey);
  ASSERT_TRUE(png);
  const cv::Mat picture = testing::decoded_png(*png);
  ASSERT_EQ(picture.size(), cv::Size(256, 256));
  const GridGeometry whole{2.0, {217000, -2090000}, 500, 500};
  int wrong = 0;
  for (int y = 0; y < 256; ++y) {
    for (int x = 0; x < 256; ++x) {
      const GridPoint ground = map.zone.project(lat_lon({256.0 * tile.x + x + 0.5, 256.0 * tile.y + y + 0.5}, 18));
      const auto p = whole.position_of(ground);
      const bool inside = p.col >= 0 && p.row >= 0 && p.col < 500 && p.row < 500;
      const Cell cell =
          inside ? cell_at(217000 + static_cast<int>(p.col), -2090000 + static_cast<int>(p.row)) : kUnobserved;
      const auto& pixel = picture.at<cv::Vec4b>(y, x);
      if (is_observed(cell) != (pixel[3] == 255)) ++wrong;
      if (is_observed(cell) && pixel[3] == 255 && (cell == kRoad) != (pixel[0] >= 128)) ++wrong;
    }
  }
  EXPECT_LT(wrong, 65536 / 50) << "only pixels on the edge of a stripe may differ";
}

TEST(TilePicture, IsAbsentWhereNothingWasObserved) {
  const MapView map = striped_map();
  EXPECT_FALSE(tile_png(map, tile_of(map.zone.unproject({434100.0, 4179500.0}), 19), TileStyle::kColour))
      << "unobserved west";
  EXPECT_FALSE(tile_png(map, {3, 0, 0}, TileStyle::kColour));
}

TEST(TilePicture, CanBeRenderedAtEveryZoom) {
  const MapView map = striped_map();
  const LatLon inside = map.zone.unproject({434700.0, 4179500.0});
  for (int zoom = 0; zoom < 10; ++zoom)
    EXPECT_NO_THROW(tile_png(map, tile_of(inside, zoom), TileStyle::kColour)) << zoom;
  for (int zoom = 10; zoom <= kMaxZoom; ++zoom) {
    EXPECT_TRUE(tile_png(map, tile_of(inside, zoom), TileStyle::kColour)) << zoom;
  }
}

}  // namespace
}  // namespace roadfix::mercator
