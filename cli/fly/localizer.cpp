#include "cli/fly/localizer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <ctime>
#include <utility>

#include "cli/evaluation/nees.hpp"
#include "core/units/error.hpp"

namespace roadfix::fly {
namespace {

class LibraryLocalizer : public Localizer {
 public:
  LibraryLocalizer(const MapView& map, const TrackSettings& settings, std::stop_token stop) : tracker_(map, settings) {
    limits_.deadline = Deadline(std::move(stop));
  }

  TrackEstimate advance(const Report& step) override {
    assert(step.frame == nullptr);
    StepResult result = tracker_.advance(state_, step, limits_);
    state_ = std::move(result.state);
    return std::move(result.estimate);
  }

  std::vector<GeoPose> particles(std::size_t count) const override { return tracker_.particles(state_, count); }

  /// Of this thread: wall-clock time says little on a machine that others use too.
  double clock_ms() const override {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
  }

  void finish() override {}

 private:
  const Tracker tracker_;
  StepLimits limits_;
  TrackerState state_;
};

Record judged(const FlightStep& step, TrackEstimate estimate, const UtmZone& zone) {
  Record record;
  record.sequence = step.input.sequence;
  record.time_s = 1e-6 * static_cast<double>(step.input.time_us);
  record.truth = step.truth;
  record.saw = step.input.saw();
  record.estimate = std::move(estimate);
  const TrackCluster& best = record.estimate.clusters.front();
  record.best = on_grid(best.pose, zone);
  const GridPoint at = record.best.position;
  record.error_m = distance_m(at, step.truth.position);
  record.heading_error_deg = angular_distance(record.best.heading, step.truth.heading).degrees();
  record.nees = evaluation::nees(at, on_grid(best.ellipse, zone, at), step.truth.position);
  return record;
}

}  // namespace

std::unique_ptr<Localizer> make_localizer(const MapView& map, const TrackSettings& settings, std::stop_token stop) {
  return std::make_unique<LibraryLocalizer>(map, settings, std::move(stop));
}

TrackSettings filter_named(const std::string& name, int particles) {
  TrackSettings settings = TrackSettings::paper(particles);
  if (name == "paper") return settings;
  settings.measurement_model = {};
  if (name == "likelihood") return settings;
  settings.filter = {};
  settings.filter.max_particles = particles;
  settings.filter.min_particles = std::min(settings.filter.min_particles, particles);
  settings.filter.adapts_count = false;
  if (name == "injection") return settings;
  settings.start = TrackStart::kSearch;
  settings.recovers = true;
  settings.beyond_map_m = TrackSettings().beyond_map_m;
  if (name == "search") return settings;
  settings.filter.adapts_count = true;
  if (name == "default") return settings;
  throw InvalidInput("filter-unknown", fmt::format("'{}' is not a filter: choose from {}", name, kFilterNames));
}

std::vector<Record> localize(const Flight& flight, Localizer& localizer, const UtmZone& zone, const Watcher& watch) {
  std::vector<Record> records;
  for (const FlightStep& step : flight) {
    const double before = localizer.clock_ms();
    TrackEstimate estimate = localizer.advance(step.input);
    const double spent = localizer.clock_ms() - before;
    records.push_back(judged(step, std::move(estimate), zone));
    records.back().step_ms = spent;
    watch(records.back(), localizer);
  }
  localizer.finish();
  return records;
}

}  // namespace roadfix::fly
