#include "server/api/json_parts.hpp"

namespace roadfix::api {

using nlohmann::json;

json pose_json(const GeoPose& pose) {
  return {
      {"lat", pose.position.lat_deg}, {"lon", pose.position.lon_deg}, {"heading_deg", pose.heading.compass_degrees()}};
}

json bbox_json(const GeoBox& box) {
  return {box.south_west.lon_deg, box.south_west.lat_deg, box.north_east.lon_deg, box.north_east.lat_deg};
}

json to_json(const MapId& map) { return {{"name", map.name}, {"version", map.version}}; }

json made_by(const std::optional<std::string>& detector) {
  json made{{"roadfix", ROADFIX_VERSION}};
  if (detector) made["detector"] = *detector;
  return made;
}

}  // namespace roadfix::api
