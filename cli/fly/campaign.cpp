#include "cli/fly/campaign.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <utility>

#include "core/units/error.hpp"

namespace roadfix::fly {
namespace {

/// Owns its tracker.
class OwnedLocalizer : public Localizer {
 public:
  OwnedLocalizer(const MapView& map, const TrackSettings& settings, std::stop_token stop)
      : tracker_(map, settings), localizer_(make_localizer(tracker_, std::move(stop))) {}

  TrackEstimate advance(const StepInput& step) override { return localizer_->advance(step); }
  std::vector<GeoPose> particles(std::size_t count) const override { return localizer_->particles(count); }

 private:
  Tracker tracker_;
  std::unique_ptr<Localizer> localizer_;
};

class Counter {
 public:
  explicit Counter(const Campaign& campaign)
      : campaign_(campaign),
        total_(static_cast<std::int64_t>(campaign.runs) * campaign.plan.steps *
               static_cast<std::int64_t>(1 + campaign.filters.size())) {}

  void step() {
    if (campaign_.stop.stop_requested()) throw Interrupted("flight-stopped", "the flights were stopped");
    campaign_.progress(++done_, total_);
  }

 private:
  const Campaign& campaign_;
  std::int64_t total_;
  std::atomic<std::int64_t> done_ = 0;
};

}  // namespace

std::vector<FilterRuns> run(const Campaign& campaign, const UtmZone& zone) {
  std::vector<FilterRuns> results;
  for (const std::string& filter : campaign.filters) {
    results.push_back({filter, std::vector<Run>(static_cast<std::size_t>(campaign.runs))});
  }
  Counter counter(campaign);
  tbb::task_arena arena(campaign.jobs);
  arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, static_cast<std::size_t>(campaign.runs), [&](std::size_t i) {
      const std::uint64_t seed = campaign.seed + i;
      const auto pilot = campaign.pilot();
      const Flight flight = fly(campaign.plan, campaign.box, *pilot, *campaign.sensor, seed, [&] { counter.step(); });
      for (FilterRuns& result : results) {
        const auto localizer = campaign.localizer(result.filter, seed);
        result.runs[i] = {seed, localize(flight, *localizer, zone, [&](const Record& record, const Localizer& at) {
                            counter.step();
                            if (i == 0) campaign.watch(result.filter, record, at);
                          })};
      }
    });
  });
  return results;
}

LocalizerFactory library_localizers(const MapView& map, int particles, int measure_every, const VehicleNoise& vehicle,
                                    std::stop_token stop) {
  return [=](const std::string& filter, std::uint64_t seed) -> std::unique_ptr<Localizer> {
    TrackSettings settings = filter_named(filter, particles);
    settings.measure_every = measure_every;
    settings.vehicle = vehicle;
    settings.seed = seed;
    return std::make_unique<OwnedLocalizer>(map, settings, stop);
  };
}

}  // namespace roadfix::fly
