#include "core/routes/mission_plan.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/routes/mission_way.hpp"
#include "core/routes/route_json.hpp"

namespace roadfix::routes {
namespace {

constexpr double kMostCommands = 65'535.0;

std::string name_of(int number) { return fmt::format("item {}", number); }

LatLon position_in(const std::vector<JsonField>& numbers, std::size_t first) {
  return {latitude_of(numbers[first]), longitude_of(numbers[first + 1])};
}

/// Latitude, longitude and a height, which counts as `above`; nullopt, or no number = it is not told.
RoutePlace coordinate(const JsonField& field, std::optional<HeightAbove> above, std::string name) {
  const std::vector<JsonField> numbers = field.elements();
  if (numbers.size() < 2) field.refuse("has to be a latitude and a longitude");
  RoutePlace place{position_in(numbers, 0), std::nullopt, std::move(name)};
  const auto metres = third_number(numbers);
  if (above && metres) place.height = PlannedHeight{*metres, *above};
  return place;
}

std::optional<PlannedHeight> height_of(const JsonField& item, const std::vector<JsonField>& params) {
  constexpr std::size_t kHeight = 6;
  if (!item.has("frame") || !item.at("frame").is_number()) return std::nullopt;
  if (params.size() <= kHeight || !params[kHeight].is_number()) return std::nullopt;
  return height_in_frame(item.at("frame").whole_number(0.0, kMostCommands),
                         params[kHeight].number(-kHighestM, kHighestM));
}

/// Of a simple item; at 0, 0 where its command is for the place where the vehicle is.
RoutePlace place_of(const JsonField& item, std::string name) {
  constexpr std::size_t kLatitude = 4;
  const JsonField params = item.at("params");
  const std::vector<JsonField> numbers = params.elements();
  if (numbers.size() < kLatitude + 2) params.refuse("has to hold seven numbers");
  RoutePlace place{{}, height_of(item, numbers), std::move(name)};
  const bool told = !numbers[kLatitude].is_null() && !numbers[kLatitude + 1].is_null();
  if (told) place.position = position_in(numbers, kLatitude);
  return place;
}

/// A place of a landing pattern, and what says in older plans whether its height counts from the home.
struct LandingPlace {
  const char* name;
  const char* is_relative;
};
constexpr std::array<LandingPlace, 3> kLandingPlaces{{{"loiterCoordinate", "loiterAltitudeRelative"},
                                                      {"landingApproachCoordinate", nullptr},
                                                      {"landCoordinate", "landingAltitudeRelative"}}};

/// What the height of a place of a landing pattern counts from.
std::optional<HeightAbove> height_of_landing(const JsonField& item, const LandingPlace& place) {
  for (const char* name : {"altitudesAreRelative", place.is_relative}) {
    if (name != nullptr && item.has(name)) return item.at(name).truth() ? HeightAbove::kHome : HeightAbove::kSea;
  }
  return std::nullopt;
}

/// QGroundControl writes null for what is not set.
bool is_told(const JsonField& home) {
  if (home.is_null()) return false;
  const std::vector<JsonField> numbers = home.elements();
  return numbers.size() < 2 || !(numbers[0].is_null() || numbers[1].is_null());
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
    if (!mission.has("plannedHomePosition")) return;
    const JsonField home = mission.at("plannedHomePosition");
    if (is_told(home)) way_ = MissionWay::from_home(coordinate(home, HeightAbove::kSea, "the home"));
  }

  Route read() && {
    int number = 0;
    for (const JsonField& item : mission_.at("items").elements()) add_item(item, ++number);
    return std::move(way_).route();
  }

 private:
  void add_item(const JsonField& item, int number) {
    if (item.at("type").text() == "SimpleItem") {
      add_command(item, number);
    } else {
      add_pattern(item, number);
    }
  }

  void add_command(const JsonField& item, int number) {
    const std::string name = name_of(number);
    way_.follow(item.at("command").whole_number(0.0, kMostCommands), name, [&] { return place_of(item, name); });
  }

  void add_pattern(const JsonField& item, int number) {
    const std::string kind = item.at("complexItemType").text();
    const std::vector<JsonField> transects = transects_of(item);
    if (!transects.empty()) {
      for (const JsonField& part : transects) add_command(part, number);
    } else if (item.has("landCoordinate")) {
      for (const LandingPlace& place : kLandingPlaces) {
        if (!item.has(place.name)) continue;
        way_.fly_to(coordinate(item.at(place.name), height_of_landing(item, place), name_of(number)));
      }
    } else {
      way_.leave_out(fmt::format("{}, a {}: the plan does not say which way it leads", name_of(number), kind));
    }
  }

  const JsonField mission_;
  MissionWay way_;
};

}  // namespace

bool is_mission_plan(const JsonField& document) {
  return document.is_object() && document.has("mission") && document.at("mission").is_object();
}

Route parse_mission_plan(const JsonField& document) { return PlanReader(document.at("mission")).read(); }

}  // namespace roadfix::routes
