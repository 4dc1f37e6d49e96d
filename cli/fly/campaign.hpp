// Many flights, each told to several filters.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "cli/fly/flight.hpp"
#include "cli/fly/localizer.hpp"
#include "cli/fly/summary.hpp"
#include "core/geodesy/geo_box.hpp"
#include "core/locate/prior.hpp"
#include "core/units/progress.hpp"

namespace roadfix::fly {

struct FilterRuns {
  std::string filter;
  std::vector<Run> runs;
};

/// Makes the localizer of a flight: by the name of the filter, with that seed, told where the flight begins.
using LocalizerFactory =
    std::function<std::unique_ptr<Localizer>(const std::string& filter, std::uint64_t seed, const Prior& start)>;

/// A flight, by its number and seed; `seen` is to be called after each step.
using FlightSource = std::function<Flight(int number, std::uint64_t seed, const std::function<void()>& seen)>;

/// What is flown, and how much of it.
struct Flights {
  FlightSource source;
  int number = 1;
  std::int64_t steps = 0;  ///< of all together, at most; for the progress
};

/// What filters are told of where flights begin.
struct ToldStart {
  std::optional<GeoBox> box;
  std::optional<double> radius_m;           ///< of a circle that holds the start, anywhere in it
  std::optional<Angle> heading_half_width;  ///< of a range of headings that holds that of the start
};

struct Campaign {
  Flights flights;
  ToldStart start;
  LocalizerFactory localizer;
  std::vector<std::string> filters{"default"};
  std::uint64_t seed = 1;  ///< of the first flight; the next ones count up
  int jobs = 1;            ///< flights at a time; results do not depend on it
  /// Of the first flight, from one thread, filter by filter; may be empty.
  std::function<void(const std::string& filter, const Record& record, const Localizer& localizer)> watch;
  OnProgress progress;  ///< in steps
  std::stop_token stop;
};

/// In the order of the filters. Throws what flights and filters throw, and Interrupted "work-stopped".
std::vector<FilterRuns> run(const Campaign& campaign, const UtmZone& zone);

/// Filters of the library on one map.
LocalizerFactory library_localizers(const MapView& map, const FilterPlan& plan, std::stop_token stop);

}  // namespace roadfix::fly
