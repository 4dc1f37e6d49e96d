#include "server/api/localizability_picture.hpp"

#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "tiles/mercator/tile_ground.hpp"
#include "tiles/mercator/tile_painting.hpp"

namespace roadfix::api {
namespace {

constexpr double kFinest = 0.5;    // of the footprint: places nearer to each other see mostly the same
constexpr double kCoarsest = 4.0;  // of the footprint

double tile_m(const MapView& map, int zoom) {
  const GridPoint middle = map.extent.centre();
  return mercator::kTilePixels * mercator::metres_per_pixel(map.zone.unproject(middle).lat_deg, zoom);
}

/// The answers of the squares, each asked for once.
class Squares {
 public:
  Squares(const MapView& map, double side_m, const AnswerAt& answer_at)
      : map_(map), side_m_(side_m), answer_at_(answer_at) {}

  std::optional<PlaceAnswer> at(GridPoint point) {
    if (!map_.extent.contains(point)) return std::nullopt;
    const Index index{std::lround(point.east_m / side_m_), std::lround(point.north_m / side_m_)};
    const auto known = known_.find(index);
    if (known != known_.end()) return known->second;
    // The middle of a square that the border of the map cuts may lie outside.
    const GridPoint middle{side_m_ * static_cast<double>(index.first), side_m_ * static_cast<double>(index.second)};
    return known_[index] = map_.extent.contains(middle) ? answer_at_(middle) : std::nullopt;
  }

 private:
  using Index = std::pair<long, long>;
  const MapView& map_;
  double side_m_;
  const AnswerAt& answer_at_;
  std::map<Index, std::optional<PlaceAnswer>> known_;
};

mercator::Pixel localizability_pixel(const PlaceAnswer& answer, mercator::TileStyle style) {
  if (style == mercator::TileStyle::kGrey) return mercator::grey_pixel(255.0 * answer.probability);
  // Red, green, blue. The red is much darker than the green, for those who do not tell the two by their hue.
  constexpr std::array<double, 3> kNoFix{217, 48, 37};
  constexpr std::array<double, 3> kAmbiguous{244, 201, 93};
  if (answer.fix) return {126, 224, 161, 128};
  const auto blend = [&](std::size_t channel) {
    return static_cast<std::uint8_t>(std::lround(std::lerp(kNoFix[channel], kAmbiguous[channel], answer.probability)));
  };
  return {blend(0), blend(1), blend(2), 128};
}

}  // namespace

std::optional<double> square_m(const MapView& map, int zoom, double footprint_m) {
  double side_m = kFinest * footprint_m;
  const double min_m = tile_m(map, zoom) / kSquaresAcross;
  while (side_m < min_m) side_m *= 2.0;
  return side_m > kCoarsest * footprint_m ? std::nullopt : std::optional(side_m);
}

ZoomRange localizability_zooms(const MapView& map, double footprint_m) {
  ZoomRange zooms;
  while (zooms.first < mercator::kMaxZoom && !square_m(map, zooms.first, footprint_m)) ++zooms.first;
  zooms.last = zooms.first;
  while (zooms.last < mercator::kMaxZoom && square_m(map, zooms.last, footprint_m) > kFinest * footprint_m)
    ++zooms.last;
  return zooms;
}

std::optional<std::vector<std::byte>> localizability_png(const MapView& map, mercator::TileAddress tile,
                                                         double footprint_m, mercator::TileStyle style,
                                                         const AnswerAt& answer_at) {
  if (map.extent.empty()) return std::nullopt;
  const std::optional<double> side_m = square_m(map, tile.z, footprint_m);
  const mercator::PixelBox box = mercator::touched_pixels(map, tile);
  if (!side_m || box.empty()) return std::nullopt;
  const mercator::PixelToGrid ground(map.zone, tile, box);
  Squares squares(map, *side_m, answer_at);
  return mercator::painted_tile(ground, box, [&](GridPoint point) -> std::optional<mercator::Pixel> {
    const auto answer = squares.at(point);
    return answer ? std::optional(localizability_pixel(*answer, style)) : std::nullopt;
  });
}

}  // namespace roadfix::api
