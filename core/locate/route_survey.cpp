#include "core/locate/route_survey.hpp"

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
  explicit Way(std::vector<GridPoint> points) : points_(std::move(points)) {
    for (std::size_t i = 1; i < points_.size(); ++i) {
      passed_m_.push_back(passed_m_.back() + distance_m(points_[i - 1], points_[i]));
    }
  }

  double length_m() const { return passed_m_.back(); }

  /// 0 <= at_m <= length_m().
  GridPoint at(double at_m) const {
    const auto next = std::clamp<std::size_t>(first_beyond(at_m), 1, points_.size() - 1);
    const GridPoint from = points_[next - 1];
    const GridPoint to = points_[next];
    const double leg_m = passed_m_[next] - passed_m_[next - 1];
    const double share = leg_m > 0.0 ? std::min((at_m - passed_m_[next - 1]) / leg_m, 1.0) : 0.0;
    return {std::lerp(from.east_m, to.east_m, share), std::lerp(from.north_m, to.north_m, share)};
  }

  /// Its ends, and the points between them.
  std::vector<GridPoint> stretch(double from_m, double to_m) const {
    std::vector<GridPoint> line{at(from_m)};
    for (std::size_t i = first_beyond(from_m); i < points_.size() && passed_m_[i] < to_m; ++i) {
      line.push_back(points_[i]);
    }
    line.push_back(at(to_m));
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

Way way_on(const MapView& map, std::span<const LatLon> route) {
  std::vector<GridPoint> points;
  for (const LatLon place : route) {
    const auto point = map.zone.project_if_defined(place);
    if (!point) refuse_outside(map);
    points.push_back(*point);
  }
  Way way(std::move(points));
  if (way.length_m() > 0.0) return way;
  throw InvalidInput("route-without-length", "the route stays where it begins: give one of at least two places");
}

void ask(const MapView& map, GridPoint place, LocalizabilityQuery query, RoutePiece& piece) {
  query.position = map.zone.unproject(place);
  const Localizability found = localizability(map, query);
  piece.kind = kind_of(found);
  piece.probability = found.probability;
}

}  // namespace

std::int64_t RouteSurvey::count(PlaceKind kind) const { return std::ranges::count(pieces, kind, &RoutePiece::kind); }

std::optional<double> RouteSurvey::first_fix_m() const {
  const auto first = std::ranges::find(pieces, PlaceKind::kDistinct, &RoutePiece::kind);
  if (first == pieces.end()) return std::nullopt;
  return piece_m() * static_cast<double>(first - pieces.begin());
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

RouteSurvey survey_route(const MapView& map, std::span<const LatLon> route, const RouteSurveyOptions& options) {
  const Way way = way_on(map, route);
  const double wanted = std::round(way.length_m() / options.every_m);
  const auto count = static_cast<std::int64_t>(std::clamp(wanted, 1.0, static_cast<double>(options.max_places)));
  RouteSurvey survey{way.length_m(), std::vector<RoutePiece>(static_cast<std::size_t>(count))};
  const double piece_m = survey.piece_m();
  std::vector<std::pair<std::size_t, GridPoint>> on_map;
  for (std::size_t i = 0; i < survey.pieces.size(); ++i) {
    const double from_m = piece_m * static_cast<double>(i);
    for (const GridPoint point : way.stretch(from_m, std::min(from_m + piece_m, way.length_m()))) {
      survey.pieces[i].line.push_back(map.zone.unproject(point));
    }
    const GridPoint middle = way.at(from_m + 0.5 * piece_m);
    if (map.extent.contains(middle)) on_map.emplace_back(i, middle);
  }
  if (on_map.empty()) refuse_outside(map);
  std::int64_t done = 0;
  std::mutex mutex;
  parallel_for(static_cast<int>(on_map.size()), options.threads, [&](int index) {
    const auto& [piece, middle] = on_map[static_cast<std::size_t>(index)];
    ask(map, middle, options.query, survey.pieces[piece]);
    const std::lock_guard lock(mutex);
    ++done;
    if (options.progress) options.progress(done, std::ssize(on_map));
  });
  return survey;
}

}  // namespace roadfix
