// Where the commands of a MAVLink mission lead the vehicle (MAV_CMD, mavlink.io/en/messages/common.html).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/routes/route.hpp"

namespace roadfix::routes {

/// Of an item in a frame (MAV_FRAME); nullopt where that is none of heights on the globe.
inline std::optional<PlannedHeight> height_in_frame(std::int64_t frame, double metres) {
  switch (frame) {
    case 0:
    case 5:
      return PlannedHeight{metres, HeightAbove::kSea};
    case 3:
    case 6:
      return PlannedHeight{metres, HeightAbove::kHome};
    case 10:
    case 11:
      return PlannedHeight{metres, HeightAbove::kGround};
    default:
      return std::nullopt;
  }
}

class MissionWay {
 public:
  /// Of a mission that tells its home besides, from there on; a place that is not told is none.
  static MissionWay from_home(RoutePlace home) {
    MissionWay way;
    if (is_told(home.position)) way.begin_at(std::move(home));
    return way;
  }
  /// Of a mission whose first item is its home, at 0, 0 where that is not told.
  static MissionWay from_first_place() {
    MissionWay way;
    way.first_is_home_ = true;
    return way;
  }
  MissionWay() = default;  ///< of a mission without a home

  /// `name`: of the item, for the user. `place_of` is called for commands that lead to a place: a RoutePlace, at 0, 0
  /// for where the vehicle is.
  template <typename PlaceOf>
  void follow(std::int64_t command, const std::string& name, const PlaceOf& place_of) {
    if (command == kReturnToLaunch && home_) return_home();
    if (jumps(command)) leave_out(name + ", a jump: the way back, and the laps after the first");
    if (!leads_somewhere(command)) return;
    RoutePlace place = place_of();
    const bool is_home = std::exchange(first_is_home_, false);
    if (!is_told(place.position)) {
      if (takes_off(command)) climb(place.height);
    } else if (is_home) {
      begin_at(std::move(place));
    } else {
      fly_to(std::move(place));
    }
  }
  void fly_to(RoutePlace place) { places_.push_back(std::move(place)); }
  void leave_out(std::string what) { left_out_.push_back(std::move(what)); }

  Route route() && {
    Route route{std::move(places_), std::move(left_out_), {}};
    if (home_) {
      route.home = *home_;
    } else if (!route.places.empty()) {
      route.home = {route.places.front().position, std::nullopt};
    }
    return route;
  }

 private:
  static constexpr std::int64_t kReturnToLaunch = 20;

  /// Parameters 5 and 6 are a place that it flies to: waypoints, loiters, landings, take-offs, splines, deliveries.
  static bool leads_somewhere(std::int64_t command) {
    constexpr std::array<std::int64_t, 12> kFlownTo{16, 17, 18, 19, 21, 22, 31, 36, 82, 84, 85, 94};
    return std::ranges::find(kFlownTo, command) != kFlownTo.end();
  }
  static bool takes_off(std::int64_t command) { return command == 22 || command == 84; }
  static bool jumps(std::int64_t command) { return command == 177 || command == 601; }  // to an item, or a tag
  /// Autopilots take both as 0 for a place that is not told.
  static bool is_told(LatLon place) { return place.lat_deg != 0.0 || place.lon_deg != 0.0; }

  /// On its ground, however high above the sea that lies.
  void begin_at(RoutePlace home) {
    home_ = RouteHome{home.position, std::nullopt};
    if (home.height && home.height->above == HeightAbove::kSea) home_->above_sea_m = home.height->metres;
    if (!home.height || home_->above_sea_m) home.height = PlannedHeight{0.0, HeightAbove::kHome};
    fly_to(std::move(home));
  }
  /// As high as it is: how high it returns is set in the autopilot.
  void return_home() {
    RoutePlace back = places_.back();
    back.position = home_->position;
    fly_to(std::move(back));
  }
  /// Straight up, which adds nothing to the way.
  void climb(const std::optional<PlannedHeight>& height) {
    if (height && !places_.empty()) places_.back().height = height;
  }

  bool first_is_home_ = false;
  std::optional<RouteHome> home_;
  std::vector<RoutePlace> places_;
  std::vector<std::string> left_out_;
};

}  // namespace roadfix::routes
