// Along what course `roadfix fly` leads its simulated vehicles.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "cli/fly/flight.hpp"
#include "cli/fly/fly_options.hpp"
#include "cli/fly/pilot.hpp"
#include "core/geodesy/utm.hpp"

namespace roadfix::cli {

/// The places of a file; empty where no file is flown. Throws what reading a route throws.
std::vector<GridPoint> course_of(const FlyOptions& options, const UtmZone& zone);

/// One for each flight: along the course where there is one, else as the options say within the box.
std::function<std::unique_ptr<fly::Pilot>()> pilots_of(const FlyOptions& options, const GridBox& box,
                                                       const std::vector<GridPoint>& course);

/// Of a flight: the plan's, or those to the end of a course where these are fewer; wind may make it more or fewer.
/// Throws InvalidInput "bad-parameter" where nobody said how many, and the course does not end.
int steps_of(const FlyOptions& options, const std::vector<GridPoint>& course, const fly::FlightPlan& plan);

}  // namespace roadfix::cli
