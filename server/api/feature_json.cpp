#include "server/api/feature_json.hpp"

#include "server/api/base64.hpp"

namespace roadfix::api {

using nlohmann::json;

json to_json(const FeatureMap& features) {
  return {{"cols", features.cells.cols()},
          {"rows", features.cells.rows()},
          {"cell_m", features.cell_m},
          {"nadir_col", features.nadir.col},
          {"nadir_row", features.nadir.row},
          {"nadir_sigma_m", features.nadir_sigma_m},
          {"nadir_heading_sigma_deg", features.nadir_heading_sigma.degrees()},
          {"cells", base64_encoded(features.cells.cells())}};
}

}  // namespace roadfix::api
