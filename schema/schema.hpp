// The files of schema/, embedded when the build is configured.
#pragma once

#include <string_view>

namespace roadfix::schema {

/// Statements that make the tables of an empty map file (schema/map.sql).
std::string_view map_sql();

/// Statements that make the tables of a map's terrain (schema/terrain.sql).
std::string_view terrain_sql();

/// Statements that make the tables of the track store where they are not there yet (schema/tracks.sql).
std::string_view tracks_sql();

/// Every route of the service, OpenAPI 3.1 (schema/openapi.json).
std::string_view openapi_json();

/// How sure the service is of its answers (schema/calibration.json).
std::string_view calibration_json();

}  // namespace roadfix::schema
