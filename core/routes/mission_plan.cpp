#include "core/routes/mission_plan.hpp"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "core/routes/mission_way.hpp"
#include "core/routes/route_json.hpp"

namespace roadfix::routes {
namespace {

constexpr double kMostCommands = 65'535.0;

LatLon place_in(const std::vector<JsonField>& numbers, std::size_t first) {
  return {latitude_of(numbers[first]), longitude_of(numbers[first + 1])};
}

/// Latitude, longitude and an altitude.
LatLon coordinate(const JsonField& field) {
  const std::vector<JsonField> numbers = field.elements();
  if (numbers.size() < 2) field.refuse("has to be a latitude and a longitude");
  return place_in(numbers, 0);
}

/// Of a simple item; nullopt where its command is for the place where the vehicle is.
std::optional<LatLon> place_of(const JsonField& item) {
  constexpr std::size_t kLatitude = 4;
  const JsonField params = item.at("params");
  const std::vector<JsonField> numbers = params.elements();
  if (numbers.size() < kLatitude + 2) params.refuse("has to hold seven numbers");
  if (numbers[kLatitude].is_null() || numbers[kLatitude + 1].is_null()) return std::nullopt;
  return place_in(numbers, kLatitude);
}

/// The commands of which surveys and corridors are made.
std::vector<JsonField> transects_of(const JsonField& item) {
  if (!item.has("TransectStyleComplexItem")) return {};
  const JsonField transects = item.at("TransectStyleComplexItem");
  return transects.has("Items") ? transects.at("Items").elements() : std::vector<JsonField>{};
}

class PlanReader {
 public:
  explicit PlanReader(const JsonField& mission) : mission_(mission) {
    if (mission.has("plannedHomePosition")) {
      way_ = MissionWay::from_home(coordinate(mission.at("plannedHomePosition")));
    }
  }

  Route read() && {
    int number = 0;
    for (const JsonField& item : mission_.at("items").elements()) add_item(item, ++number);
    return {way_.places(), std::move(left_out_)};
  }

 private:
  void add_item(const JsonField& item, int number) {
    if (item.at("type").text() == "SimpleItem") {
      add_command(item);
    } else {
      add_pattern(item, number);
    }
  }

  void add_command(const JsonField& item) {
    way_.follow(item.at("command").whole_number(0.0, kMostCommands), [&] { return place_of(item); });
  }

  void add_pattern(const JsonField& item, int number) {
    const std::string kind = item.at("complexItemType").text();
    const std::vector<JsonField> transects = transects_of(item);
    if (!transects.empty()) {
      for (const JsonField& part : transects) add_command(part);
    } else if (item.has("landCoordinate")) {
      if (item.has("landingApproachCoordinate")) way_.fly_to(coordinate(item.at("landingApproachCoordinate")));
      way_.fly_to(coordinate(item.at("landCoordinate")));
    } else {
      left_out_.push_back(fmt::format("item {}, a {}: the plan does not say which way it leads", number, kind));
    }
  }

  const JsonField mission_;
  MissionWay way_;
  std::vector<std::string> left_out_;
};

}  // namespace

bool is_mission_plan(const JsonField& document) {
  return document.is_object() && document.has("mission") && document.at("mission").is_object();
}

Route parse_mission_plan(const JsonField& document) { return PlanReader(document.at("mission")).read(); }

}  // namespace roadfix::routes
