#include "core/survey/map_survey.hpp"

#include <algorithm>
#include <mutex>
#include <vector>

#include "core/survey/observed_places.hpp"
#include "core/units/parallel_for.hpp"

namespace roadfix {
namespace {

/// Of a list, so many at most, at equal distances in it.
std::vector<GridPoint> thinned(const std::vector<GridPoint>& places, std::int64_t most) {
  const auto all = static_cast<std::int64_t>(places.size());
  const std::int64_t kept = std::min(all, std::max<std::int64_t>(1, most));
  std::vector<GridPoint> result;
  for (std::int64_t i = 0; i < kept; ++i) {
    result.push_back(places[static_cast<std::size_t>((2 * i + 1) * all / (2 * kept))]);
  }
  return result;
}

void count(MapSurvey& survey, const Localizability& place) {
  switch (kind_of(place)) {
    case PlaceKind::kDistinct:
      ++survey.distinct;
      return;
    case PlaceKind::kSparse:
      ++survey.sparse;
      return;
    case PlaceKind::kBare:
      ++survey.bare;
      return;
    case PlaceKind::kUnknown:
      return;  // overviews show ground with gaps as whole
  }
}

}  // namespace

MapSurvey survey(const MapView& map, const SurveyOptions& options) {
  const ObservedPlaces observed =
      observed_places(map, options.query.footprint_m, kMinObservedShare, options.query.fix.search.deadline.stop());
  const std::vector<GridPoint> places = thinned(observed.places, options.max_places);
  MapSurvey result;
  std::int64_t done = 0;
  std::mutex mutex;
  parallel_for(static_cast<int>(places.size()), options.threads, [&](int index) {
    LocalizabilityQuery query = options.query;
    query.position = map.zone.unproject(places[static_cast<std::size_t>(index)]);
    const Localizability place = localizability(map, query);
    const std::lock_guard lock(mutex);
    count(result, place);
    ++done;
    if (options.progress) options.progress(done, static_cast<std::int64_t>(places.size()));
  });
  if (done > 0) {
    result.ground_m2 = observed.ground_m2 * static_cast<double>(result.places()) / static_cast<double>(done);
  }
  return result;
}

}  // namespace roadfix
