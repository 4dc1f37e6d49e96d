#include "core/survey/localizability.hpp"
#include "core/routes/route.hpp"
#include "core/survey/route_survey.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/units/error.hpp"
#include "core/units/json_text.hpp"
#include "core/units/lru_cache.hpp"
#include "server/api/fields.hpp"
#include "server/api/fix_json.hpp"
#include "server/api/fix_request.hpp"
#include "server/api/frame_scale.hpp"
#include "server/api/json_parts.hpp"
#include "server/api/localizability_picture.hpp"
#include "server/api/route_json.hpp"
#include "server/api/tile_address.hpp"
#include "server/api/time_limit.hpp"
#include "server/handlers/answers.hpp"
#include "server/handlers/handlers.hpp"
#include "server/handlers/tile_answers.hpp"
#include "server/http/admission.hpp"
#include "server/http/errors.hpp"

namespace roadfix::server {
namespace {

constexpr api::Range kFootprint{kSmallestFootprintM, kLargestFootprintM};
constexpr api::Range kRadius{0.0, 20'000.0, true};
constexpr double kUsualFootprintM = 400.0;
constexpr int kTilesDrawn = 1;            ///< at a time
constexpr std::size_t kPlaceBytes = 160;  // that one takes beside its key and a copy of it
constexpr std::size_t kPlacesBytes = std::size_t{16} << 20;

FixOptions fix_options(const Service& service, const http::Request& request, std::stop_token stop = {}) {
  FixOptions options;
  options.max_search_km2 = service.limits.search_km2;
  options.calibration = service.calibration;
  options.search.deadline = api::search_end(request.deadline, std::move(stop));
  return options;
}

http::Response get_localizability(const Service& service, const http::Request& request) {
  const auto map = service.maps.find(request.path_parameters.at("map"));
  const api::Fields fields(request.query);
  LocalizabilityQuery query;
  query.position = {fields.number("lat", api::kLatitude), fields.number("lon", api::kLongitude)};
  query.footprint_m = fields.number("footprint_m", kFootprint);
  query.radius_m = fields.optional_number("radius_m", kRadius).value_or(query.radius_m);
  const api::HangUp hang_up(request.abandoned);
  query.fix = fix_options(service, request, hang_up.token());
  const SearchThreads::Share share(service.search_threads);
  query.fix.search.threads = share.threads();
  nlohmann::json answer = api::to_json(localizability(map->view, query));
  answer["map"] = api::to_json(map->view.id);
  return json_response(answer);
}

constexpr std::size_t kLongestRoute = std::size_t{1} << 20;  // bytes
constexpr int kMostPlaces = 1000;
constexpr api::Range kRouteLength{0.0, 2e7};  // metres: half around the Earth

constexpr api::Range kAspect{0.1, 10.0};

/// The footprint, or a camera from whose height it follows.
void read_footprint(const api::Fields& fields, RouteSurveyOptions& options) {
  const auto fov = fields.optional_angle("fov_deg", api::kFieldOfView);
  if (!fov) {
    for (const char* name : {"aspect", "agl_m"}) {
      if (fields.has(name)) {
        throw http::InvalidField("missing-parameter", "fov_deg", fmt::format("'{}' takes fov_deg", name));
      }
    }
    options.query.footprint_m = fields.number("footprint_m", kFootprint);
    return;
  }
  if (fields.has("footprint_m")) {
    throw http::InvalidField("bad-parameter", "footprint_m", "'footprint_m' cannot be combined with fov_deg");
  }
  options.camera = DownwardCamera{*fov};
  options.camera->aspect = fields.optional_number("aspect", kAspect).value_or(options.camera->aspect);
  options.usual_agl_m = fields.optional_number("agl_m", api::kHeightAboveGround);
}

routes::Route route_in(const http::Request& request) {
  constexpr std::array<std::string_view, 4> kTypes{"application/json", "application/geo+json", "text/plain",
                                                   "application/octet-stream"};
  const std::string type = request.media_type();
  if (std::ranges::find(kTypes, type) == kTypes.end()) {
    throw http::InvalidField(
        "unsupported-media-type", "Content-Type",
        fmt::format("Content-Type is '{}'; send a route as {}", type.substr(0, 60), fmt::join(kTypes, ", ")));
  }
  if (request.body.size() > kLongestRoute) {
    throw LimitExceeded("route-too-long", fmt::format("the route has {} bytes; at most {} are allowed",
                                                      request.body.size(), kLongestRoute));
  }
  return routes::parse_route(request.body);
}

/// All other ranges were looked at when they were read.
RouteSurvey surveyed(const MapView& map, const routes::Route& route, const RouteSurveyOptions& options) {
  try {
    return survey_route(map, route, options);
  } catch (const InvalidInput& error) {
    if (error.code() != "parameter-out-of-range") throw;
    throw http::InvalidField(error.code(), "from_m", error.what());
  }
}

http::Response post_route(const Service& service, const http::Request& request) {
  const auto map = service.maps.find(request.path_parameters.at("map"));
  const api::Fields fields(request.query);
  RouteSurveyOptions options;
  read_footprint(fields, options);
  options.query.radius_m = fields.optional_number("radius_m", kRadius).value_or(options.query.radius_m);
  options.every_m = fields.optional_number("every_m", api::kPositive);
  options.max_places = fields.optional_integer("places", 1, kMostPlaces).value_or(kMostPlaces);
  options.limit = fields.optional_integer("limit", 1, kMostPlaces).value_or(kMostPlaces);
  options.from_m = fields.optional_number("from_m", kRouteLength).value_or(0.0);
  const routes::Route route = route_in(request);
  const api::HangUp hang_up(request.abandoned);
  options.query.fix = fix_options(service, request, hang_up.token());
  const SearchThreads::Share share(service.search_threads);
  options.query.fix.search.threads = share.threads();
  const RouteSurvey found = surveyed(map->view, route, options);
  nlohmann::json answer = api::geojson_of(found);
  answer.update(api::summary_json(found));
  answer["complete"] = found.complete();
  if (!found.complete()) answer["next_m"] = found.begin_m(std::ssize(found.pieces));
  answer["left_out"] = route.left_out;
  answer["map"] = api::to_json(map->view.id);
  return {200, "application/geo+json", json_text(answer)};
}

/// What tells one picture of a tile from another.
struct Layer {
  std::shared_ptr<const ServedMap> map;
  double footprint_m = 0.0;
  mercator::TileStyle style = mercator::TileStyle::kColour;

  std::string key() const { return fmt::format("{}/{}/localizability/{}", map->name(), map->edition(), footprint_m); }
};

Layer layer_of(const Service& service, const http::Request& request) {
  const api::Fields fields(request.query);
  return {service.maps.find(request.path_parameters.at("map")),
          fields.optional_number("footprint_m", kFootprint).value_or(kUsualFootprintM),
          fields.choice("style", kTileStyles)};
}

std::optional<api::PlaceAnswer> searched(const Service& service, const http::Request& request, const Layer& layer,
                                         GridPoint place) {
  LocalizabilityQuery query;
  query.position = layer.map->view.zone.unproject(place);
  query.footprint_m = layer.footprint_m;
  query.fix = fix_options(service, request);
  const Localizability found = localizability(layer.map->view, query);
  if (!found.complete) {
    throw Interrupted("request-deadline", "the time limit ended before the tile was complete; ask again");
  }
  const PlaceKind kind = kind_of(found);
  if (kind == PlaceKind::kUnknown) return std::nullopt;
  return api::PlaceAnswer{kind == PlaceKind::kDistinct, found.probability};
}

/// What the tiles of all maps share.
struct Tiles {
  explicit Tiles(int waiting) : turns(kTilesDrawn, waiting) {}

  http::Admission turns;
  /// A tile that runs out of time goes on where it was when it is asked for again.
  LruCache<std::string, std::optional<api::PlaceAnswer>> places{kPlacesBytes};
};

std::string drawn(const Service& service, const http::Request& request, const Layer& layer, mercator::TileAddress tile,
                  Tiles& tiles) {
  const auto answer_at = [&](GridPoint place) {
    const std::string key = fmt::format("{}/{}/{}", layer.key(), place.east_m, place.north_m);
    if (const auto kept = tiles.places.find(key)) return *kept;
    if (request.abandoned()) throw http::ClientGone();
    const std::optional<api::PlaceAnswer> answer = searched(service, request, layer, place);
    tiles.places.insert(key, answer, kPlaceBytes + 2 * key.size());
    return answer;
  };
  const std::string key = fmt::format("{}/{}/{}/{}/{}", layer.key(), to_string(layer.style), tile.z, tile.x, tile.y);
  return kept_or_drawn(service.pictures, key, [&] {
    const http::Admission::Ticket turn = tiles.turns.enter(request.client, request.deadline, request.abandoned);
    return api::localizability_png(layer.map->view, tile, layer.footprint_m, layer.style, answer_at);
  });
}

/// A service that is started with another calibration draws other tiles.
std::string variation(const Service& service, const Layer& layer, const std::string& path) {
  const Calibration& c = *service.calibration;
  std::string key = fmt::format("{} {} {} {} {} {} {}", path, layer.footprint_m, to_string(layer.style), c.bias,
                                c.highest, c.position_sigma_scale, c.heading_sigma_scale);
  for (const Calibration::Term& term : c.terms) key += fmt::format(" {} {}", term.weight, term.max);
  return key;
}

http::Response get_localizability_tile(const Service& service, const http::Request& request, Tiles& tiles) {
  const auto& at = request.path_parameters;
  const mercator::TileAddress tile = api::parse_tile(at.at("z"), at.at("x"), at.at("y"));
  const Layer layer = layer_of(service, request);
  const std::string tag = entity_tag(layer.map->edition(), variation(service, layer, request.path));
  return tile_response(request, tag, [&] { return drawn(service, request, layer, tile, tiles); });
}

http::Response get_localizability_tilejson(const Service& service, const http::Request& request) {
  const Layer layer = layer_of(service, request);
  const std::string query = fmt::format("&footprint_m={}", layer.footprint_m) + style_query(layer.style);
  nlohmann::json answer = tilejson(request, *layer.map, layer.map->name() + ", localizability", query);
  if (!layer.map->view.extent.empty()) {
    const api::ZoomRange zooms = api::localizability_zooms(layer.map->view, layer.footprint_m);
    answer["minzoom"] = zooms.first;
    answer["maxzoom"] = zooms.last;
  }
  return tilejson_response(answer);
}

}  // namespace

void add_localizability_routes(Routes& routes) {
  routes.add("GET", "/v1/maps/{map}/localizability", {"lat", "lon", "footprint_m", "radius_m"}, get_localizability,
             http::Load::kHeavy);
  routes.add("POST", "/v1/maps/{map}/localizability",
             {"footprint_m", "fov_deg", "aspect", "agl_m", "radius_m", "every_m", "places", "from_m", "limit"},
             post_route, http::Load::kHeavy);
  // Not among the heavy requests: a screen of these tiles must not hold up a fix.
  const auto tiles = std::make_shared<Tiles>(routes.service().http.threads / kThreadsPerWaiting);
  routes.add(
      "GET", "/v1/maps/{map}/localizability/tiles/{z}/{x}/{y}.png", {"footprint_m", "style", "version"},
      [tiles](const Service& service, const http::Request& request) {
        return get_localizability_tile(service, request, *tiles);
      },
      http::Load::kLong);
  routes.add("GET", "/v1/maps/{map}/localizability/tilejson.json", {"footprint_m", "style"},
             get_localizability_tilejson);
}

}  // namespace roadfix::server
