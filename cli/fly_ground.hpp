// What a vehicle of `roadfix fly` flies over, where, and how.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "cli/fly/pilot.hpp"
#include "cli/fly_options.hpp"
#include "core/locate/tracker.hpp"

namespace roadfix::cli {

/// The map to localize on, or the middle of it.
MapView map_of(const FlyOptions& options);

/// The ground that the vehicle looks at, whichever it is.
struct Ground {
  std::optional<Orthoimage> imagery;
  std::unique_ptr<RoadDetector> detector;
  std::unique_ptr<fly::Sensor> sensor;
  GridBox box;
  std::string what;
};

Footprint footprint_of(const FlyOptions& options);
Ground ground_of(const FlyOptions& options, const MapView& map);
fly::FlightPlan plan_of(const FlyOptions& options, const MapView& map, const Ground& ground);
/// Where the whole footprint lies on the map and on what is flown over, whatever the heading. Throws InvalidInput
/// "no-place-to-fly".
GridBox flying_box(const FlyOptions& options, const MapView& map, const GridBox& ground);
std::function<std::unique_ptr<fly::Pilot>()> pilots_of(const FlyOptions& options, const GridBox& box,
                                                       const UtmZone& zone);
VehicleNoise vehicle_of(const FlyOptions& options);

}  // namespace roadfix::cli
