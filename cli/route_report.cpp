#include "cli/route_report.hpp"

#include <fmt/format.h>

#include "cli/place_kinds.hpp"
#include "server/api/route_json.hpp"

namespace roadfix::cli {
namespace {

std::string place_text(LatLon place) { return fmt::format("{:.6f} {:.6f}", place.lat_deg, place.lon_deg); }

std::string longest_text(const RouteSurvey& survey) {
  const IndexRange gap = survey.longest_without_fix();
  if (gap.count() == 0) return "  a fix all along\n";
  const RoutePiece& first = survey.pieces[static_cast<std::size_t>(gap.first)];
  const RoutePiece& last = survey.pieces[static_cast<std::size_t>(gap.end - 1)];
  return fmt::format("  longest without a fix: {:.1f} km, from km {:.1f} ({}) to km {:.1f} ({})\n",
                     survey.piece_m * gap.count() / 1e3, survey.begin_m(gap.first) / 1e3,
                     place_text(first.line.front()), survey.begin_m(gap.end) / 1e3, place_text(last.line.back()));
}

}  // namespace

std::string route_text(const RouteSurvey& survey, const std::string& route, double footprint_m) {
  std::string text = fmt::format("{}: {:.1f} km, for frames that show {:g} m of ground; asked every {:.0f} m\n", route,
                                 survey.length_m / 1e3, footprint_m, survey.piece_m);
  for (const PlaceKind kind : {PlaceKind::kDistinct, PlaceKind::kSparse, PlaceKind::kBare, PlaceKind::kUnknown}) {
    text += kind_line(kind, api::share_of(survey, kind), survey.length_m / 1e3, "km");
  }
  if (const auto first = survey.first_fix_m(); first && *first > 0.0) {
    text += fmt::format("  first fix after {:.1f} km\n", *first / 1e3);
  }
  return text + longest_text(survey);
}

}  // namespace roadfix::cli
