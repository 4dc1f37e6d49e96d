#include "cli/fly/fly_course.hpp"

#include <fmt/format.h>

#include "cli/route_input.hpp"
#include "core/units/error.hpp"

namespace roadfix::cli {

std::vector<GridPoint> course_of(const FlyOptions& options, const UtmZone& zone) {
  std::vector<GridPoint> points;
  if (options.course == "random" || options.course == "survey") return points;
  const routes::Route route = route_with_notes(options.course);
  return said_of(options.course, [&] {
    for (const routes::RoutePlace& place : route.places) points.push_back(zone.project(place.position));
    return points;
  });
}

std::function<std::unique_ptr<fly::Pilot>()> pilots_of(const FlyOptions& options, const GridBox& box,
                                                       const std::vector<GridPoint>& course) {
  const fly::Handling handling = options.plan.handling;
  if (options.course == "random") return [=] { return fly::make_random_pilot(box, handling); };
  const auto points = options.course == "survey" ? fly::survey_lanes(box, options.lane_m) : course;
  return [=] { return fly::make_waypoint_pilot(points, handling); };
}

int steps_of(const FlyOptions& options, const std::vector<GridPoint>& course, const fly::FlightPlan& plan) {
  if (course.empty()) return plan.steps;
  const auto pilot = fly::make_waypoint_pilot(course, plan.handling);
  const int steps = fly::steps_to_the_end(plan, *pilot, options.campaign.seed);
  if (options.steps || steps < plan.steps) return steps;
  throw InvalidInput("bad-parameter",
                     fmt::format("{} is not flown to its end in {} steps: give a greater --speed, --turn-rate or "
                                 "--step-s, or say with --steps how many to fly",
                                 options.course, steps));
}

}  // namespace roadfix::cli
