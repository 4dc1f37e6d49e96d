// Sources of a map as the API and `roadfix --json` give them.
#pragma once

#include <nlohmann/json.hpp>

#include "tiles/store/map_records.hpp"

namespace roadfix::api {

/// What anyone may read: neither where its files lie nor what identifies them.
nlohmann::json to_json(const SourceStatus& source);

/// The same as its `shift`.
nlohmann::json to_json(const SourceShift& shift);

}  // namespace roadfix::api
