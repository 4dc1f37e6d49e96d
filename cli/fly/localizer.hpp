// Who is told what the vehicle tells, and answers where it is: the library, or a service.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cli/fly/flight.hpp"
#include "core/track/tracker.hpp"

namespace roadfix::fly {

class Localizer {
 public:
  virtual ~Localizer() = default;
  virtual TrackEstimate advance(const Report& step) = 0;
  /// Of the belief after the last step.
  virtual std::vector<GeoPose> particles(std::size_t count) const = 0;
  /// The clock that a step's time is taken by.
  virtual double clock_ms() const = 0;
  /// After the last step.
  virtual void finish() = 0;
};

/// The tracker of the library, for flights whose vehicle detects roads itself.
std::unique_ptr<Localizer> make_localizer(const MapView& map, const TrackSettings& settings, std::stop_token stop);

/// What all filters are asked for alike.
struct FilterPlan {
  int particles = 10'000;  ///< at most
  bool start_is_known = false;
  VehicleNoise vehicle = {};
};

/// From the paper's filter to the default, one improvement after the other.
inline constexpr const char* kFilterNames = "paper, likelihood, injection, search, default";

/// Throws InvalidInput "filter-unknown". At most `particles` of them.
TrackSettings filter_named(const std::string& name, int particles);

/// One step with its truth.
struct Record {
  std::int64_t sequence = 0;
  double time_s = 0.0;
  GridPose truth;
  bool saw = false;  ///< a frame was there
  TrackEstimate estimate;
  GridPose best;  ///< of the heaviest cluster
  double error_m = 0.0;
  double heading_error_deg = 0.0;
  double nees = 0.0;     ///< squared error of the position in units of the stated ellipse
  double step_ms = 0.0;  ///< by the localizer's clock
};

/// Called after each step.
using Watcher = std::function<void(const Record& record, const Localizer& localizer)>;

std::vector<Record> localize(const Flight& flight, Localizer& localizer, const UtmZone& zone, const Watcher& watch);

}  // namespace roadfix::fly
