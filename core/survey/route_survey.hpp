// Before the flight: where along a route does a frame tell its place, and how long does the flight go without?
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/routes/route.hpp"
#include "core/survey/flight_heights.hpp"
#include "core/survey/localizability.hpp"
#include "core/units/index_range.hpp"
#include "core/units/progress.hpp"

namespace roadfix {

struct RouteSurveyOptions {
  /// Of each place; its position is not read, nor its footprint where there is a camera.
  LocalizabilityQuery query;
  /// Whose footprint follows how high the route is; nullopt = it does not.
  std::optional<DownwardCamera> camera{};
  std::optional<double> usual_agl_m{};  ///< as of FlightHeights
  /// About the length of the pieces of the route, above 0; nullopt = half a footprint, or half their mean.
  std::optional<double> every_m{};
  std::int64_t max_places = 1000;  ///< longer pieces where it would be more; each takes about a second of one core
  double from_m = 0.0;             ///< begins with the piece that begins there, as RouteSurvey::begin_m() tells it
  std::int64_t limit = 1'000'000;  ///< pieces in this answer, at most; above 0
  int threads = 1;
  OnProgress progress{};  ///< in places
};

/// A stretch of the route, all of it straight between the places on the way; what holds in its middle counts for it.
struct RoutePiece {
  std::vector<LatLon> line;  ///< two places at least
  /// With a footprint of less than kSmallestFootprintM it is kBare, of more than kLargestFootprintM or none kUnknown.
  PlaceKind kind = PlaceKind::kUnknown;
  double probability = 0.0;             ///< that a frame would be placed rightly
  std::optional<double> agl_m{};        ///< of a survey with a camera, where it is known
  std::optional<double> footprint_m{};  ///< the same
};

struct MetreRange {
  double least_m = 0.0;
  double most_m = 0.0;
};

struct RouteSurvey {
  double length_m = 0.0;           ///< of the whole route
  double piece_m = 0.0;            ///< of each piece
  std::int64_t first = 0;          ///< pieces of the route before these
  std::vector<RoutePiece> pieces;  ///< in the order of the flight, to the end of the route, the limit, or the deadline

  /// Of a piece of these, along the route; also of the one after the last.
  double begin_m(std::int64_t piece) const { return piece_m * static_cast<double>(first + piece); }
  /// Whether they lead to the end of the route.
  bool complete() const;
  std::int64_t count(PlaceKind kind) const;
  /// Where along the route the first of these pieces begins that gives a fix; nullopt if none does.
  std::optional<double> first_fix_m() const;
  /// The most pieces in a row none of which is distinct; the first of equal ones. Empty where all are.
  IndexRange longest_without_fix() const;
  /// Of RoutePiece::agl_m or ::footprint_m, where they are known; nullopt where they are of no piece.
  std::optional<MetreRange> range(std::optional<double> RoutePiece::*of) const;
};

/// Asks localizability() in the middle of each piece of the way from place to place. Throws what that throws, what
/// FlightHeights() does where there is a camera, and InvalidInput "route-outside-map" where no piece lies within the
/// box of the map or a place lies where its zone is not defined, "route-without-length", "parameter-out-of-range" where
/// `from_m` lies beyond its end.
RouteSurvey survey_route(const MapView& map, const routes::Route& route, const RouteSurveyOptions& options);

}  // namespace roadfix
