// A map as the API and `roadfix info --json` give it.
#pragma once

#include <nlohmann/json.hpp>

#include "tiles/store/map_reader.hpp"

namespace roadfix::api {

/// What a list of maps says of each.
nlohmann::json summary_json(const MapInfo& info);

/// Their `terrain`: what anyone may read of the heights of the ground.
nlohmann::json to_json(const TerrainStatus& terrain);

/// All that anyone may read, its sources too.
nlohmann::json to_json(const MapInfo& info);

}  // namespace roadfix::api
