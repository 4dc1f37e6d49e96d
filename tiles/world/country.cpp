#include "tiles/world/country.hpp"

#include "tiles/world/barriers.hpp"
#include "tiles/world/country_survey.hpp"
#include "tiles/world/farmsteads.hpp"
#include "tiles/world/random.hpp"
#include "tiles/world/street_network.hpp"
#include "tiles/world/tracks.hpp"
#include "tiles/world/woods.hpp"

namespace roadfix::world {
namespace {

/// Streams of random numbers, apart from those of towns.
enum Stream : std::uint64_t { kLand = 101, kBarriers, kTracks, kFarms, kTrees, kTraffic };

}  // namespace

void lay_out_country(Plan& plan, std::uint64_t seed) {
  Random land(seed, kLand);
  survey_country(plan, land);
  Random barrier(seed, kBarriers);
  lay_barriers(plan, barrier);
  Random track(seed, kTracks);
  wander(plan, track);
  Random farm(seed, kFarms);
  settle(plan, farm);
  sort_by_width(plan.streets);
  Random tree(seed, kTrees);
  grow(plan, tree);
  Random vehicle(seed, kTraffic);
  plan.boxes = country_traffic(plan, vehicle);
}

}  // namespace roadfix::world
