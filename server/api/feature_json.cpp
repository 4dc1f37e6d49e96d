#include "server/api/feature_json.hpp"

#include "server/api/base64.hpp"
#include "server/api/json_parts.hpp"

namespace roadfix::api {
namespace {

using nlohmann::json;

json without_cells(const FeatureMap& features) {
  return {{"cols", features.cells.cols()},
          {"rows", features.cells.rows()},
          {"cell_m", features.cell_m},
          {"nadir_col", features.nadir.col},
          {"nadir_row", features.nadir.row},
          {"nadir_sigma_m", features.nadir_sigma_m},
          {"nadir_heading_sigma_deg", features.nadir_heading_sigma.degrees()}};
}

}  // namespace

json to_json(const FeatureMap& features) {
  json answer = without_cells(features);
  answer["cells"] = base64_encoded(features.cells.cells());
  return answer;
}

json detection_json(const Features& features) {
  json answer = without_cells(features.map);
  answer["time_ms"] = {{"detect", features.detect_time.value().count()}};
  answer["made_by"] = made_by(features.detector);
  return answer;
}

}  // namespace roadfix::api
