// What a vehicle of `roadfix fly` flies over, where, and how: simulated, or as it was recorded.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cli/fly/campaign.hpp"
#include "cli/fly/fly_options.hpp"
#include "cli/fly/recording.hpp"
#include "core/track/tracker.hpp"

namespace roadfix::cli {

/// The map to localize on, or the middle of it.
MapView map_of(const FlyOptions& options);

/// The ground that the vehicle looks at, whichever it is.
struct Ground {
  std::unique_ptr<const Orthoimage> imagery;  ///< null where there is none; the sensor looks at it
  std::shared_ptr<const RoadDetector> detector;
  std::unique_ptr<fly::Sensor> sensor;     ///< null where flights were recorded
  std::vector<fly::Recording> recordings;  ///< empty where flights are simulated
  std::vector<GridPoint> course;           ///< of a file; empty where another is flown
  GridBox box;
  Footprint footprint;  ///< of a recorded flight that of its first frame
  std::string what;
};

/// Throws InvalidInput for options that do not go together, and what reading the ground throws.
Ground ground_of(const FlyOptions& options, const MapView& map);
fly::FlightPlan plan_of(const FlyOptions& options, const MapView& map, const Ground& ground);

/// `ground` must outlive them. Throws InvalidInput "no-place-to-fly" where the footprint does not fit on the map and on
/// what is flown over, and what reading waypoints throws.
fly::Flights flights_of(const FlyOptions& options, const MapView& map, const Ground& ground,
                        const fly::FlightPlan& plan);

VehicleNoise vehicle_of(const FlyOptions& options);

}  // namespace roadfix::cli
