#include "cli/fly/campaign.hpp"

#include <cstdint>
#include <exception>
#include <mutex>
#include <utility>

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
    for (FilterRuns& result : results) {
      const auto localizer = campaign.localizer(result.filter, seed);
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
  return [=](const std::string& filter, std::uint64_t seed) -> std::unique_ptr<Localizer> {
    TrackSettings settings = filter_named(filter, plan.particles);
    settings.vehicle = plan.vehicle;
    settings.seed = seed;
    settings.max_search_km2.reset();  // nobody waits for the processors
    return make_localizer(map, settings, stop);
  };
}

}  // namespace roadfix::fly
