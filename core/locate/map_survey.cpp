#include "core/locate/map_survey.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "core/units/parallel_for.hpp"

namespace roadfix {
namespace {

/// The middles of squares that cover a box, which is not empty, but for half a square on each side.
class Lattice {
 public:
  Lattice(const GridBox& box, double side_m)
      : middle_(box.centre()), side_m_(side_m), cols_(count(box.width_m())), rows_(count(box.height_m())) {}

  std::int64_t size() const { return std::int64_t{cols_} * rows_; }
  double side_m() const { return side_m_; }
  GridPoint at(int index) const {
    return {middle_.east_m + from_middle(index % cols_, cols_), middle_.north_m - from_middle(index / cols_, rows_)};
  }

 private:
  int count(double length_m) const { return std::max(1, static_cast<int>(std::lround(length_m / side_m_))); }
  double from_middle(int i, int count) const { return side_m_ * (i - (count - 1) / 2.0); }

  GridPoint middle_;
  double side_m_;
  int cols_;
  int rows_;
};

Lattice lattice_of(const GridBox& box, double footprint_m, std::int64_t max_places) {
  Lattice lattice(box, footprint_m);
  while (lattice.size() > std::max<std::int64_t>(1, max_places)) lattice = Lattice(box, 2.0 * lattice.side_m());
  return lattice;
}

void count(MapSurvey& survey, const Localizability& place) {
  if (place.observed_share < kMinObservedShare) return;
  if (place.status == FixStatus::kFix) {
    ++survey.distinct;
  } else if (place.reason == "too-few-roads") {
    ++survey.bare;
  } else {
    ++survey.sparse;
  }
}

}  // namespace

MapSurvey survey(const MapView& map, const SurveyOptions& options) {
  MapSurvey result;
  if (map.extent.empty()) return result;
  const Lattice lattice = lattice_of(map.extent, options.query.footprint_m, options.max_places);
  result.every_m = lattice.side_m();
  std::int64_t done = 0;
  std::mutex mutex;
  parallel_for(static_cast<int>(lattice.size()), options.threads, [&](int index) {
    LocalizabilityQuery query = options.query;
    query.position = map.zone.unproject(lattice.at(index));
    const Localizability place = localizability(map, query);
    const std::lock_guard lock(mutex);
    count(result, place);
    ++done;
    if (options.progress) options.progress(done, lattice.size());
  });
  return result;
}

}  // namespace roadfix
