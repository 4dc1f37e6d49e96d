// Which of the peaks that a search found count as other places than the best one.
#pragma once

#include "core/locate/calibration.hpp"
#include "core/locate/ellipse.hpp"
#include "core/locate/map_view.hpp"

namespace roadfix {

/// Whether two poses are so close to each other, within 25 m and 15 degrees, that they may be one place.
bool is_same_place(const GridPose& a, const GridPose& b);

/// Of the position of a mode, as a fix states it. `nadir_sigma_m`: of the FeatureMap that was searched for.
PositionCovariance told_covariance(const MapView& map, const Calibration& calibration, double nadir_sigma_m,
                                   const SearchMode& mode);

/// Whether a pose may be that of an answer with this covariance: is_same_place(), and within kRegionSigmas.
bool lies_within(const GridPose& answer, const PositionCovariance& covariance, const GridPose& pose);

/// A mode is another place than the best one if it does not lie within that:
/// - SearchResult::nearby joins the modes and the rivals within the region if it is beyond kRegionSigmas of the stated
///   ellipse, as where sources of a map are shifted against each other.
/// - Modes that are no other places are removed from SearchResult::outside. The ellipse is that of the peak alone here,
///   since errors of registration and nadir move both modes alike.
void sort_out_other_places(const MapView& map, const Calibration& calibration, double nadir_sigma_m,
                           SearchResult& found);

}  // namespace roadfix
