#include "cli/route_report.hpp"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>
#include <string_view>

#include "core/units/words.hpp"
#include "server/api/geojson.hpp"

namespace roadfix::cli {
namespace {

using nlohmann::json;

constexpr std::array<Word<PlaceKind>, 4> kKinds{{{"distinct", PlaceKind::kDistinct},
                                                 {"sparse", PlaceKind::kSparse},
                                                 {"bare", PlaceKind::kBare},
                                                 {"unknown", PlaceKind::kUnknown}}};

constexpr std::array<Word<PlaceKind>, 4> kMeanings{
    {{"a frame gives a fix", PlaceKind::kDistinct},
     {"its roads fit elsewhere, too, or are too few to be sure: no fix, but a track may go on", PlaceKind::kSparse},
     {"it shows hardly any road: no fix, and a track has odometry alone", PlaceKind::kBare},
     {"half or more of it is not on the map: odometry alone", PlaceKind::kUnknown}}};

double share(const RouteSurvey& survey, PlaceKind kind) {
  return static_cast<double>(survey.count(kind)) / static_cast<double>(survey.pieces.size());
}

double begin_m(const RouteSurvey& survey, int piece) { return survey.piece_m() * piece; }

std::string place_text(LatLon place) { return fmt::format("{:.6f} {:.6f}", place.lat_deg, place.lon_deg); }

std::string longest_text(const RouteSurvey& survey) {
  const IndexRange gap = survey.longest_without_fix();
  if (gap.count() == 0) return "  a fix all along\n";
  const auto& first = survey.pieces[static_cast<std::size_t>(gap.first)];
  const auto& last = survey.pieces[static_cast<std::size_t>(gap.end - 1)];
  return fmt::format("  longest without a fix: {:.1f} km, from km {:.1f} ({}) to km {:.1f} ({})\n",
                     begin_m(survey, gap.count()) / 1e3, begin_m(survey, gap.first) / 1e3,
                     place_text(first.line.front()), begin_m(survey, gap.end) / 1e3, place_text(last.line.back()));
}

}  // namespace

std::string route_text(const RouteSurvey& survey, const std::string& route, double footprint_m) {
  std::string text = fmt::format("{}: {:.1f} km, for frames that show {:g} m of ground; asked every {:.0f} m\n", route,
                                 survey.length_m / 1e3, footprint_m, survey.piece_m());
  for (const auto& [word, kind] : kKinds) {
    const double part = share(survey, kind);
    text += fmt::format("  {:<9} {:3.0f} %  {:6.1f} km  {}\n", word, 100.0 * part, part * survey.length_m / 1e3,
                        word_of(kMeanings, kind));
  }
  if (const auto first = survey.first_fix_m(); first && *first > 0.0) {
    text += fmt::format("  first fix after {:.1f} km\n", *first / 1e3);
  }
  return text + longest_text(survey);
}

json route_json(const RouteSurvey& survey) {
  const IndexRange gap = survey.longest_without_fix();
  const auto first = survey.first_fix_m();
  json answer{{"length_m", survey.length_m},
              {"places", survey.pieces.size()},
              {"every_m", survey.piece_m()},
              {"first_fix_m", first ? json(*first) : json()},
              {"longest_without_fix", {{"from_m", begin_m(survey, gap.first)}, {"to_m", begin_m(survey, gap.end)}}}};
  for (const auto& [word, kind] : kKinds) answer[std::string(word)] = share(survey, kind);
  return answer;
}

json route_geojson(const RouteSurvey& survey) {
  json features = json::array();
  for (int i = 0; i < static_cast<int>(survey.pieces.size()); ++i) {
    const RoutePiece& piece = survey.pieces[static_cast<std::size_t>(i)];
    features.push_back({{"type", "Feature"},
                        {"geometry", api::line_json(piece.line)},
                        {"properties",
                         {{"from_m", begin_m(survey, i)},
                          {"to_m", begin_m(survey, i + 1)},
                          {"place", word_of(kKinds, piece.kind)},
                          {"probability", piece.probability}}}});
  }
  return {{"type", "FeatureCollection"}, {"features", std::move(features)}};
}

}  // namespace roadfix::cli
