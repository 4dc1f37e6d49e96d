#include "core/locate/nearby_place.hpp"

#include <algorithm>
#include <functional>
#include <vector>

#include "core/locate/ellipse.hpp"

namespace roadfix {
namespace {

constexpr double kOnePlaceM = 25.0;  // places farther apart are two, however badly either is known

/// Of the position of a mode as a fix tells it.
PositionCovariance told_covariance(const MapView& map, const Calibration& calibration, double nadir_sigma_m,
                                   const SearchMode& mode) {
  const double scale2 = calibration.position_sigma_scale * calibration.position_sigma_scale;
  const double nadir2 = nadir_sigma_m * nadir_sigma_m;
  const PositionCovariance matched = position_covariance(map, mode.pose.position, mode.covariance);
  return {scale2 * matched.east_east + nadir2, scale2 * matched.east_north, scale2 * matched.north_north + nadir2};
}

}  // namespace

void count_nearby_place(const MapView& map, const Calibration& calibration, double nadir_sigma_m, SearchResult& found) {
  if (!found.nearby) return;
  const SearchMode& nearby = *found.nearby;
  const SearchMode& best = found.modes.front();
  const double mahalanobis2 = squared_mahalanobis(best.pose.position, nearby.pose.position,
                                                  told_covariance(map, calibration, nadir_sigma_m, best));
  const bool is_near = distance_m(best.pose.position, nearby.pose.position) <= kOnePlaceM;
  if (is_near && !(mahalanobis2 > kRegionSigmas * kRegionSigmas)) return;
  const auto lower = [&](const SearchMode& mode) { return mode.score < nearby.score; };
  found.modes.insert(std::find_if(found.modes.begin() + 1, found.modes.end(), lower), nearby);
  std::vector<double>& rivals = found.background.rivals_within;
  rivals.insert(std::ranges::upper_bound(rivals, nearby.score, std::ranges::greater{}), nearby.score);
}

}  // namespace roadfix
