// Feature maps as the API gives and takes them.
#pragma once

#include <nlohmann/json.hpp>

#include "core/grid/feature_map.hpp"
#include "server/api/features.hpp"

namespace roadfix::api {

/// cols, rows, cell_m, nadir, and the cells as base64.
nlohmann::json to_json(const FeatureMap& features);
/// Of roads that were detected: the same without the cells, time_ms and made_by.
nlohmann::json detection_json(const Features& features);

}  // namespace roadfix::api
