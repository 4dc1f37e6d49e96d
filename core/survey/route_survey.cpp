#include "core/survey/route_survey.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include "core/units/error.hpp"
#include "core/units/parallel_for.hpp"

namespace roadfix {
namespace {

/// The way from point to point, measured from its begin.
class Way {
 public:
  struct Spot {
    GridPoint point;
    std::size_t from = 0;  ///< number of the point that it lies behind
    double share = 0.0;    ///< of the way from there to the next that lies behind it
  };

  explicit Way(std::vector<GridPoint> points) : points_(std::move(points)) {
    for (std::size_t i = 1; i < points_.size(); ++i) {
      passed_m_.push_back(passed_m_.back() + distance_m(points_[i - 1], points_[i]));
    }
  }

  double length_m() const { return passed_m_.back(); }

  /// 0 <= at_m <= length_m().
  Spot at(double at_m) const {
    const auto next = std::clamp<std::size_t>(first_beyond(at_m), 1, points_.size() - 1);
    const GridPoint from = points_[next - 1];
    const GridPoint to = points_[next];
    const double leg_m = passed_m_[next] - passed_m_[next - 1];
    const double share = leg_m > 0.0 ? std::min((at_m - passed_m_[next - 1]) / leg_m, 1.0) : 0.0;
    const GridPoint point{std::lerp(from.east_m, to.east_m, share), std::lerp(from.north_m, to.north_m, share)};
    return {point, next - 1, share};
  }

  /// Its ends, and the points between them.
  std::vector<GridPoint> stretch(double from_m, double to_m) const {
    std::vector<GridPoint> line{at(from_m).point};
    for (std::size_t i = first_beyond(from_m); i < points_.size() && passed_m_[i] < to_m; ++i) {
      line.push_back(points_[i]);
    }
    line.push_back(at(to_m).point);
    return line;
  }

 private:
  std::size_t first_beyond(double at_m) const {
    return static_cast<std::size_t>(std::ranges::upper_bound(passed_m_, at_m) - passed_m_.begin());
  }

  std::vector<GridPoint> points_;
  std::vector<double> passed_m_{0.0};
};

[[noreturn]] void refuse_outside(const MapView& map) {
  throw InvalidInput("route-outside-map",
                     fmt::format("no part of the route lies on the map {}: check that they belong together (roadfix "
                                 "info says where the map lies)",
                                 map.id.name));
}

Way way_on(const MapView& map, const routes::Route& route) {
  std::vector<GridPoint> points;
  for (const routes::RoutePlace& planned : route.places) {
    const LatLon place = planned.position;
    const auto point = map.zone.project_if_defined(place);
    if (!point) {
      throw InvalidInput(
          "route-outside-map",
          fmt::format("the route leads to {:.4f} {:.4f}, a part of the world away from the map {}: check "
                      "that they belong together",
                      place.lat_deg, place.lon_deg, map.id.name));
    }
    points.push_back(*point);
  }
  Way way(std::move(points));
  if (way.length_m() > 0.0) return way;
  throw InvalidInput("route-without-length", "the route stays where it begins: give one of at least two places");
}

/// The pieces of a way, all as long.
class Pieces {
 public:
  Pieces(const Way& way, double about_m, std::int64_t most) : way_(way) {
    const double wanted = std::round(way.length_m() / about_m);
    count_ = static_cast<std::int64_t>(std::clamp(wanted, 1.0, static_cast<double>(most)));
  }

  std::int64_t count() const { return count_; }
  double piece_m() const { return way_.length_m() / static_cast<double>(count_); }
  Way::Spot middle(std::int64_t piece) const { return way_.at(piece_m() * (static_cast<double>(piece) + 0.5)); }
  std::vector<GridPoint> line(std::int64_t piece) const {
    const double from_m = piece_m() * static_cast<double>(piece);
    return way_.stretch(from_m, std::min(from_m + piece_m(), way_.length_m()));
  }
  bool any_within(const GridBox& box) const {
    for (std::int64_t i = 0; i < count_; ++i) {
      if (box.contains(middle(i).point)) return true;
    }
    return false;
  }

 private:
  const Way& way_;
  std::int64_t count_;
};

std::int64_t first_piece(const Pieces& pieces, double length_m, double from_m) {
  if (!(from_m >= 0.0 && from_m < length_m)) {
    throw InvalidInput("parameter-out-of-range",
                       fmt::format("the route is {:.0f} m long: it cannot be begun {} m along it", length_m, from_m));
  }
  const auto nearest = static_cast<std::int64_t>(std::round(from_m / pieces.piece_m()));
  return std::min(nearest, pieces.count() - 1);
}

/// What a camera sees along the way.
class FlownCamera {
 public:
  FlownCamera(const MapView& map, const routes::Route& route, const RouteSurveyOptions& options)
      : camera_(*options.camera), heights_(map, route, options.usual_agl_m) {}

  std::optional<double> agl_m(const Way::Spot& spot) const { return heights_.agl_m(spot.from, spot.share, spot.point); }
  double footprint_m(double agl_m) const { return camera_.footprint_m(agl_m); }

  /// Along the way, of footprints that can be asked of; nullopt where there are none.
  std::optional<double> mean_footprint_m(const Way& way) const {
    constexpr int kSamples = 1000;
    double sum_m = 0.0;
    int count = 0;
    for (int i = 0; i < kSamples; ++i) {
      const auto height_m = agl_m(way.at(way.length_m() * (i + 0.5) / kSamples));
      const double side_m = height_m ? footprint_m(*height_m) : 0.0;
      if (side_m < kSmallestFootprintM || side_m > kLargestFootprintM) continue;
      sum_m += side_m;
      ++count;
    }
    return count > 0 ? std::optional(sum_m / count) : std::nullopt;
  }

 private:
  DownwardCamera camera_;
  FlightHeights heights_;
};

double usual_piece_m(const Way& way, const std::optional<FlownCamera>& camera, const RouteSurveyOptions& options) {
  if (options.every_m) return *options.every_m;
  const auto mean_m = camera ? camera->mean_footprint_m(way) : std::nullopt;
  return 0.5 * mean_m.value_or(options.query.footprint_m);
}

/// Before anything is searched.
RoutePiece planned_piece(const MapView& map, const std::vector<GridPoint>& line, const Way::Spot& middle,
                         const std::optional<FlownCamera>& camera) {
  RoutePiece piece;
  for (const GridPoint point : line) piece.line.push_back(map.zone.unproject(point));
  if (camera) piece.agl_m = camera->agl_m(middle);
  if (piece.agl_m) piece.footprint_m = camera->footprint_m(*piece.agl_m);
  return piece;
}

/// nullopt where the deadline came first.
std::optional<RoutePiece> asked_piece(const MapView& map, RoutePiece piece, GridPoint middle, bool by_height,
                                      LocalizabilityQuery query) {
  if (!map.extent.contains(middle)) return piece;
  if (by_height) {
    if (!piece.footprint_m || *piece.footprint_m > kLargestFootprintM) return piece;
    piece.kind = PlaceKind::kBare;
    if (*piece.footprint_m < kSmallestFootprintM) return piece;
    query.footprint_m = *piece.footprint_m;
  }
  if (query.fix.search.deadline.over()) return std::nullopt;
  query.position = map.zone.unproject(middle);
  const Localizability found = localizability(map, query);
  if (!found.complete) return std::nullopt;
  piece.kind = kind_of(found);
  piece.probability = found.probability;
  return piece;
}

}  // namespace

bool RouteSurvey::complete() const { return begin_m(std::ssize(pieces)) > length_m - 0.5 * piece_m; }

std::int64_t RouteSurvey::count(PlaceKind kind) const { return std::ranges::count(pieces, kind, &RoutePiece::kind); }

std::optional<double> RouteSurvey::first_fix_m() const {
  const auto fix = std::ranges::find(pieces, PlaceKind::kDistinct, &RoutePiece::kind);
  if (fix == pieces.end()) return std::nullopt;
  return begin_m(fix - pieces.begin());
}

IndexRange RouteSurvey::longest_without_fix() const {
  IndexRange longest;
  IndexRange current;
  for (int i = 0; i < static_cast<int>(pieces.size()); ++i) {
    const bool distinct = pieces[static_cast<std::size_t>(i)].kind == PlaceKind::kDistinct;
    current = distinct ? IndexRange{i + 1, i + 1} : IndexRange{current.first, i + 1};
    if (current.count() > longest.count()) longest = current;
  }
  return longest;
}

std::optional<MetreRange> RouteSurvey::range(std::optional<double> RoutePiece::*of) const {
  std::optional<MetreRange> range;
  for (const RoutePiece& piece : pieces) {
    const std::optional<double>& metres = piece.*of;
    if (!metres) continue;
    if (!range) range = MetreRange{*metres, *metres};
    range->least_m = std::min(range->least_m, *metres);
    range->most_m = std::max(range->most_m, *metres);
  }
  return range;
}

RouteSurvey survey_route(const MapView& map, const routes::Route& route, const RouteSurveyOptions& options) {
  const Way way = way_on(map, route);
  std::optional<FlownCamera> camera;
  if (options.camera) camera.emplace(map, route, options);
  const Pieces pieces(way, usual_piece_m(way, camera, options), options.max_places);
  if (!pieces.any_within(map.extent)) refuse_outside(map);
  RouteSurvey survey{way.length_m(), pieces.piece_m(), first_piece(pieces, way.length_m(), options.from_m), {}};
  const std::int64_t count = std::min(pieces.count() - survey.first, options.limit);
  std::vector<std::optional<RoutePiece>> found(static_cast<std::size_t>(count));
  std::int64_t done = 0;
  std::mutex mutex;
  parallel_for(static_cast<int>(count), options.threads, [&](int i) {
    const std::int64_t piece = survey.first + i;
    const Way::Spot middle = pieces.middle(piece);
    auto answer = asked_piece(map, planned_piece(map, pieces.line(piece), middle, camera), middle.point,
                              camera.has_value(), options.query);
    const std::lock_guard lock(mutex);
    found[static_cast<std::size_t>(i)] = std::move(answer);
    ++done;
    if (options.progress) options.progress(done, count);
  });
  for (auto& piece : found) {
    if (!piece) break;
    survey.pieces.push_back(std::move(*piece));
  }
  return survey;
}

}  // namespace roadfix
