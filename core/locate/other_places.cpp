#include "core/locate/other_places.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace roadfix {
namespace {

void count_nearby(SearchResult& found) {
  const SearchMode& nearby = *found.nearby;
  const auto lower = [&](const SearchMode& mode) { return mode.score < nearby.score; };
  found.modes.insert(std::find_if(found.modes.begin() + 1, found.modes.end(), lower), nearby);
  std::vector<double>& rivals = found.background.rivals_within;
  rivals.insert(std::ranges::upper_bound(rivals, nearby.score, std::ranges::greater{}), nearby.score);
}

}  // namespace

bool is_same_place(const GridPose& a, const GridPose& b) {
  constexpr double kNearM = 25.0;
  const Angle near = Angle::degrees(15.0);
  return distance_m(a.position, b.position) <= kNearM && angular_distance(a.heading, b.heading) <= near;
}

PositionCovariance told_covariance(const MapView& map, const Calibration& calibration, double nadir_sigma_m,
                                   const SearchMode& mode) {
  const double scale2 = calibration.position_sigma_scale * calibration.position_sigma_scale;
  const double nadir2 = std::pow(mode.scale * nadir_sigma_m, 2.0);
  const PositionCovariance matched = position_covariance(map, mode.pose.position, mode.covariance);
  return {scale2 * matched.east_east + nadir2, scale2 * matched.east_north, scale2 * matched.north_north + nadir2};
}

bool lies_within(const GridPose& answer, const PositionCovariance& covariance, const GridPose& pose) {
  return is_same_place(answer, pose) &&
         squared_mahalanobis(answer.position, pose.position, covariance) <= kRegionSigmas * kRegionSigmas;
}

void sort_out_other_places(const MapView& map, const Calibration& calibration, double nadir_sigma_m,
                           SearchResult& found) {
  if (found.modes.empty()) return;
  const SearchMode best = found.modes.front();
  const PositionCovariance told = told_covariance(map, calibration, nadir_sigma_m, best);
  if (found.nearby && !lies_within(best.pose, told, found.nearby->pose)) count_nearby(found);
  const double peak_m2 = best.covariance[0][0] + best.covariance[1][1];
  std::erase_if(found.outside, [&](const SearchMode& mode) {
    return lies_within(best.pose, {peak_m2, 0.0, peak_m2}, mode.pose);
  });
}

}  // namespace roadfix
