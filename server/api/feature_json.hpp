// Feature maps as the API gives and takes them.
#pragma once

#include <nlohmann/json.hpp>

#include "core/grid/feature_map.hpp"

namespace roadfix::api {

/// cols, rows, cell_m, nadir, and the cells as base64.
nlohmann::json to_json(const FeatureMap& features);

}  // namespace roadfix::api
