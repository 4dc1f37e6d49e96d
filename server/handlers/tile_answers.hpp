// What tiles answer, whatever they show.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/units/words.hpp"
#include "server/http/message.hpp"
#include "server/maps/map_registry.hpp"
#include "server/maps/picture_cache.hpp"
#include "tiles/mercator/tile_picture.hpp"

namespace roadfix::server {

/// Of the parameter "style", the usual one first.
inline constexpr std::array<Word<mercator::TileStyle>, 2> kTileStyles{
    {{"colour", mercator::TileStyle::kColour}, {"grey", mercator::TileStyle::kGrey}}};
constexpr std::string_view to_string(mercator::TileStyle style) { return word_of(kTileStyles, style); }
/// To ask for it by, behind another parameter: "&style=grey"; empty for the usual one.
std::string style_query(mercator::TileStyle style);

/// The picture, or nothing where there is nothing to see.
using DrawTile = std::function<std::optional<std::vector<std::byte>>()>;
/// From the cache, or drawn now and kept; empty where there is nothing to see.
std::string kept_or_drawn(PictureCache& pictures, const std::string& key, const DrawTile& draw);

/// 304 to a client that has the picture of this tag, else what `picture` gives: 200, or 204 where it is empty.
http::Response tile_response(const http::Request& request, const std::string& tag,
                             const std::function<std::string()>& picture);

/// Of the tiles whose folder lies beside this document. Their addresses name the edition of the map, so that no client
/// shows tiles of the one before; `query` ("&style=grey") stands behind it.
nlohmann::json tilejson(const http::Request& request, const ServedMap& map, const std::string& name,
                        const std::string& query);
http::Response tilejson_response(const nlohmann::json& tilejson);

}  // namespace roadfix::server
