#include "cli/fly/campaign.hpp"

#include <cmath>
#include <cstdint>
#include <exception>
#include <mutex>
#include <utility>

#include "cli/evaluation/random.hpp"
#include "core/units/error.hpp"
#include "core/units/parallel_for.hpp"

namespace roadfix::fly {
namespace {

class Counter {
 public:
  explicit Counter(const Campaign& campaign)
      : campaign_(campaign), total_(campaign.flights.steps * static_cast<std::int64_t>(1 + campaign.filters.size())) {}

  void step() {
    if (campaign_.stop.stop_requested()) throw Interrupted("work-stopped", "the flights were stopped");
    const std::lock_guard lock(mutex_);
    if (failure_) std::rethrow_exception(failure_);
    ++done_;
    if (campaign_.progress) campaign_.progress(done_, total_);
  }

  /// Of one flight: it ends the others at their next step, since their figures would not be told.
  void fail(std::exception_ptr failure) {
    const std::lock_guard lock(mutex_);
    if (!failure_) failure_ = std::move(failure);
  }

 private:
  const Campaign& campaign_;
  std::int64_t total_;
  std::int64_t done_ = 0;
  std::mutex mutex_;
  std::exception_ptr failure_;
};

/// Random draws of a flight's own, beside those of flight.cpp.
constexpr std::uint64_t kStart = 3;

Prior prior_of(const ToldStart& start, const Flight& flight, std::uint64_t seed, const UtmZone& zone) {
  Prior prior;
  prior.box = start.box;
  if (flight.empty()) return prior;
  const GridPose& truth = flight.front().truth;
  evaluation::Random random = evaluation::stream(seed, kStart, 0);
  if (const auto half_width = start.heading_half_width) {
    const Angle off = uniform(random, -1.0, 1.0) * *half_width;
    prior.heading = HeadingRange{(on_earth(truth, zone).heading + off).wrapped(), *half_width};
  }
  if (!start.radius_m) return prior;
  const Angle direction = Angle::degrees(uniform(random, -180.0, 180.0));
  const double off_m = *start.radius_m * std::sqrt(uniform(random, 0.0, 1.0));
  const GridPoint centre{truth.position.east_m + off_m * sin(direction),
                         truth.position.north_m + off_m * cos(direction)};
  prior.circle = GeoCircle{zone.unproject(centre), *start.radius_m};
  return prior;
}

}  // namespace

std::vector<FilterRuns> run(const Campaign& campaign, const UtmZone& zone) {
  std::vector<FilterRuns> results;
  for (const std::string& filter : campaign.filters) {
    results.push_back({filter, std::vector<Run>(static_cast<std::size_t>(campaign.flights.number))});
  }
  Counter counter(campaign);
  const auto fly_one = [&](int flight_number) {
    const auto i = static_cast<std::size_t>(flight_number);
    const std::uint64_t seed = campaign.seed + i;
    const Flight flight = campaign.flights.source(flight_number, seed, [&] { counter.step(); });
    const Prior start = prior_of(campaign.start, flight, seed, zone);
    for (FilterRuns& result : results) {
      const auto localizer = campaign.localizer(result.filter, seed, start);
      result.runs[i] = {seed, localize(flight, *localizer, zone, [&](const Record& record, const Localizer& at) {
                          counter.step();
                          if (i == 0 && campaign.watch) campaign.watch(result.filter, record, at);
                        })};
    }
  };
  parallel_for(campaign.flights.number, campaign.jobs, [&](int flight_number) {
    try {
      fly_one(flight_number);
    } catch (...) {
      counter.fail(std::current_exception());
      throw;
    }
  });
  return results;
}

LocalizerFactory library_localizers(const MapView& map, const FilterPlan& plan, std::stop_token stop) {
  return [=](const std::string& filter, std::uint64_t seed, const Prior& start) -> std::unique_ptr<Localizer> {
    TrackSettings settings = filter_named(filter, plan.particles);
    settings.prior = start;
    settings.start_is_known = plan.start_is_known;
    settings.vehicle = plan.vehicle;
    settings.seed = seed;
    settings.max_search_km2.reset();  // nobody waits for the processors
    return make_localizer(map, settings, stop);
  };
}

}  // namespace roadfix::fly
