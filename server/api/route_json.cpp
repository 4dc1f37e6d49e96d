#include "server/api/route_json.hpp"

#include <cassert>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "server/api/geojson.hpp"

namespace roadfix::api {

using nlohmann::json;

double share_of(const RouteSurvey& survey, PlaceKind kind) {
  assert(!survey.pieces.empty());
  return static_cast<double>(survey.count(kind)) / static_cast<double>(survey.pieces.size());
}

json summary_json(const RouteSurvey& survey) {
  json summary{{"length_m", survey.length_m}, {"every_m", survey.piece_m}, {"places", survey.pieces.size()}};
  if (survey.pieces.empty()) return summary;
  for (const auto& [word, kind] : kPlaceKinds) summary[std::string(word)] = share_of(survey, kind);
  const auto first = survey.first_fix_m();
  const IndexRange gap = survey.longest_without_fix();
  summary["first_fix_m"] = first ? json(*first) : json();
  const auto add_range = [&](const char* name, std::optional<double> RoutePiece::*of) {
    if (const auto range = survey.range(of)) summary[name] = {range->least_m, range->most_m};
  };
  add_range("agl_range_m", &RoutePiece::agl_m);
  add_range("footprint_range_m", &RoutePiece::footprint_m);
  summary["longest_without_fix"] = {{"from_m", survey.begin_m(gap.first)}, {"to_m", survey.begin_m(gap.end)}};
  return summary;
}

json geojson_of(const RouteSurvey& survey) {
  json features = json::array();
  for (std::size_t i = 0; i < survey.pieces.size(); ++i) {
    const RoutePiece& piece = survey.pieces[i];
    const auto number = static_cast<std::int64_t>(i);
    json properties{{"from_m", survey.begin_m(number)},
                    {"to_m", survey.begin_m(number + 1)},
                    {"place", word_of(kPlaceKinds, piece.kind)},
                    {"probability", piece.probability}};
    if (piece.agl_m) properties["agl_m"] = *piece.agl_m;
    if (piece.footprint_m) properties["footprint_m"] = *piece.footprint_m;
    features.push_back(
        {{"type", "Feature"}, {"geometry", line_json(piece.line)}, {"properties", std::move(properties)}});
  }
  return {{"type", "FeatureCollection"}, {"features", std::move(features)}};
}

}  // namespace roadfix::api
