// Where the commands of a MAVLink mission lead the vehicle (MAV_CMD, mavlink.io/en/messages/common.html).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/geodesy/latlon.hpp"

namespace roadfix::routes {

class MissionWay {
 public:
  /// Of a mission that tells its home besides, from there on; a place that is not told is none.
  static MissionWay from_home(LatLon home) {
    MissionWay way;
    if (is_told(home)) way.begin_at(home);
    return way;
  }
  /// Of a mission whose first place is its home.
  static MissionWay from_first_place() {
    MissionWay way;
    way.first_is_home_ = true;
    return way;
  }
  MissionWay() = default;  ///< of a mission without a home

  /// `place_of` is called for commands that lead to a place: an optional, without a value for where the vehicle is.
  template <typename PlaceOf>
  void follow(std::int64_t command, const PlaceOf& place_of) {
    if (command == kReturnToLaunch && home_) places_.push_back(*home_);
    if (!leads_somewhere(command)) return;
    const std::optional<LatLon> place = place_of();
    if (!place || !is_told(*place)) return;
    if (first_is_home_ && !home_) {
      begin_at(*place);
    } else {
      fly_to(*place);
    }
  }
  void fly_to(LatLon place) { places_.push_back(place); }

  const std::vector<LatLon>& places() const { return places_; }

 private:
  static constexpr std::int64_t kReturnToLaunch = 20;

  /// Parameters 5 and 6 are a place that it flies to: waypoints, loiters, landings, take-offs, splines, deliveries.
  static bool leads_somewhere(std::int64_t command) {
    constexpr std::array<std::int64_t, 12> kFlownTo{16, 17, 18, 19, 21, 22, 31, 36, 82, 84, 85, 94};
    return std::ranges::find(kFlownTo, command) != kFlownTo.end();
  }
  /// Autopilots take both as 0 for a place that is not told.
  static bool is_told(LatLon place) { return place.lat_deg != 0.0 || place.lon_deg != 0.0; }

  void begin_at(LatLon home) {
    home_ = home;
    fly_to(home);
  }

  bool first_is_home_ = false;
  std::optional<LatLon> home_;
  std::vector<LatLon> places_;
};

}  // namespace roadfix::routes
