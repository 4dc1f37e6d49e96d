#include "server/api/fix_json.hpp"

#include "server/api/frame_scale.hpp"
#include "server/api/geojson.hpp"
#include "server/api/json_parts.hpp"

namespace roadfix::api {
namespace {

using nlohmann::json;

json mode_json(const FixMode& mode) {
  json answer{{"pose", pose_json(mode.pose)},
              {"scale", mode.scale},
              {"weight", mode.weight},
              {"rho", mode.rho},
              {"sigma_m", mode.ellipse.sigma_m},
              {"ellipse_heading_deg", mode.ellipse.heading.degrees()},
              {"heading_sigma_deg", mode.heading_sigma.degrees()},
              {"observed_cells", mode.observed_cells}};
  if (mode.agl_m) answer["agl_m"] = *mode.agl_m;
  return answer;
}

}  // namespace

const char* to_string(FixStatus status) {
  switch (status) {
    case FixStatus::kFix:
      return "fix";
    case FixStatus::kAmbiguous:
      return "ambiguous";
    case FixStatus::kNoFix:
      break;
  }
  return "no_fix";
}

json to_json(const Fix& fix) {
  json answer{{"status", to_string(fix.status)}};
  if (fix.status == FixStatus::kFix) {
    answer.update(mode_json(fix.modes.at(0)));
    answer.erase("weight");
    answer["geometry"] = point_json(fix.modes.at(0).pose.position);
  } else {
    answer["reason"] = fix.reason;
    answer["explanation"] = fix.explanation;
  }
  answer["probability"] = fix.probability;
  answer["modes"] = json::array();
  for (const FixMode& mode : fix.modes) answer["modes"].push_back(mode_json(mode));
  answer["searched"] = {{"area_km2", fix.searched_km2},
                        {"headings", fix.headings},
                        {"scales", fix.scales},
                        {"complete", fix.complete},
                        {"share", fix.searched_share}};
  if (fix.proof) {
    answer["searched"]["proof"] = {{"complete", fix.proof->complete}, {"best_score", fix.proof->best_score},
                                   {"bound", fix.proof->bound},       {"excluded_share", fix.proof->excluded_share},
                                   {"cell_m", fix.proof->cell_m},     {"headings", fix.proof->headings},
                                   {"scales", fix.proof->scales}};
  }
  answer["map"] = to_json(fix.map);
  answer["made_by"] = made_by();
  answer["time_ms"] = {{"search", fix.search_time.count()}};
  return answer;
}

json to_json(const Fix& fix, const Features& features) {
  json answer = to_json(fix);
  answer["made_by"] = made_by(features.detector);
  if (features.detect_time) answer["time_ms"]["detect"] = features.detect_time->count();
  if (features.camera_in_file) answer["camera"] = to_json(*features.camera_in_file);
  if (!features.left_out.empty()) answer["left_out"] = frame_numbers(features.left_out);
  return answer;
}

json to_json(const Localizability& place) {
  json answer{{"status", to_string(place.status)},
              {"probability", place.probability},
              {"road_share", place.road_share},
              {"observed_share", place.observed_share},
              {"alike", json::array()}};
  if (!place.reason.empty()) answer["reason"] = place.reason;
  if (!place.explanation.empty()) answer["explanation"] = place.explanation;
  for (const FixMode& mode : place.alike) answer["alike"].push_back(mode_json(mode));
  return answer;
}

json to_json(std::span<const MatchScore> scores, const MapView& map, const Features& features) {
  json list = json::array();
  for (const MatchScore& score : scores) {
    json entry{{"rho", nullptr}, {"probability", nullptr}, {"observed_cells", score.observed_cells}};
    if (score.rho) {
      entry["rho"] = *score.rho;
      entry["probability"] = likelihood(*score.rho);
    }
    list.push_back(std::move(entry));
  }
  json answer{{"scores", std::move(list)}, {"map", to_json(map.id)}};
  if (!features.left_out.empty()) answer["left_out"] = frame_numbers(features.left_out);
  return answer;
}

}  // namespace roadfix::api
