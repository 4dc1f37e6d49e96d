#include "core/routes/route.hpp"

#include "core/routes/geojson_line.hpp"
#include "core/routes/mission_plan.hpp"
#include "core/routes/route_json.hpp"
#include "core/routes/waypoint_list.hpp"
#include "core/units/error.hpp"
#include "core/units/file.hpp"
#include "core/units/text.hpp"

namespace roadfix::routes {
namespace {

Route route_in(std::string_view text) {
  if (is_waypoint_list(text)) return parse_waypoint_list(text);
  const nlohmann::json document = parse_json(text, kRouteJson);
  const JsonField field(document, kRouteJson);
  return is_mission_plan(field) ? parse_mission_plan(field) : parse_geojson_line(field);
}

}  // namespace

Route parse_route(std::string_view text) {
  Route route = route_in(without_byte_order_mark(text));
  if (route.places.size() < 2) throw InvalidInput(kRouteUnreadable, "a route needs at least two places");
  return route;
}

Route read_route(const std::filesystem::path& file) {
  const std::string text = read_named_file(file);
  return said_of(file.string(), [&] { return parse_route(text); });
}

}  // namespace roadfix::routes
