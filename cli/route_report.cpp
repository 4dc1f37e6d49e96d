#include "cli/route_report.hpp"

#include <fmt/format.h>

#include <algorithm>

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

std::string shown_text(const RouteSurvey& survey, std::optional<double> footprint_m) {
  if (footprint_m) return fmt::format("for frames that show {:g} m of ground", *footprint_m);
  const auto agl = survey.range(&RoutePiece::agl_m);
  const auto shown = survey.range(&RoutePiece::footprint_m);
  if (!agl || !shown) return "nowhere at a known height above ground";
  return fmt::format("{:.0f} to {:.0f} m above ground, of which frames show {:.0f} to {:.0f} m", agl->least_m,
                     agl->most_m, shown->least_m, shown->most_m);
}

template <typename Holds>
std::string stretch_text(const RouteSurvey& survey, const std::string& where, const char* advice, const Holds& holds) {
  const auto first = std::ranges::find_if(survey.pieces, holds);
  if (first == survey.pieces.end()) return "";
  const auto count = static_cast<double>(std::ranges::count_if(survey.pieces, holds));
  return fmt::format("  {:.1f} km {}, first at km {:.1f} ({}): {}\n", survey.piece_m * count / 1e3, where,
                     survey.begin_m(first - survey.pieces.begin()) / 1e3, place_text(first->line.front()), advice);
}

/// Where the footprint of a camera is none that could be asked of.
std::string heights_text(const RouteSurvey& survey) {
  const auto in_ground = [](const RoutePiece& piece) { return piece.agl_m && *piece.agl_m < 0.0; };
  const auto too_low = [&](const RoutePiece& piece) {
    return piece.agl_m && !in_ground(piece) && *piece.footprint_m < kSmallestFootprintM;
  };
  const auto too_high = [](const RoutePiece& piece) { return piece.footprint_m > kLargestFootprintM; };
  const auto unknown = [](const RoutePiece& piece) { return !piece.agl_m; };
  return stretch_text(survey, "below the ground", "check the heights of the plan and of the map's ground", in_ground) +
         stretch_text(survey, fmt::format("too low to show {:g} m of ground", kSmallestFootprintM),
                      "that counts as bare", too_low) +
         stretch_text(survey, fmt::format("so high as to show over {:g} m of ground", kLargestFootprintM),
                      "that counts as unknown", too_high) +
         stretch_text(survey, "over ground whose height the map does not know", "that counts as unknown", unknown);
}

}  // namespace

std::string route_text(const RouteSurvey& survey, const std::string& route, std::optional<double> footprint_m) {
  std::string text = fmt::format("{}: {:.1f} km, {}; asked every {:.0f} m\n", route, survey.length_m / 1e3,
                                 shown_text(survey, footprint_m), survey.piece_m);
  for (const PlaceKind kind : {PlaceKind::kDistinct, PlaceKind::kSparse, PlaceKind::kBare, PlaceKind::kUnknown}) {
    text += kind_line(kind, api::share_of(survey, kind), survey.length_m / 1e3, "km");
  }
  if (const auto first = survey.first_fix_m(); first && *first > 0.0) {
    text += fmt::format("  first fix after {:.1f} km\n", *first / 1e3);
  }
  text += longest_text(survey);
  return footprint_m ? text : text + heights_text(survey);
}

}  // namespace roadfix::cli
