// Between the places of a search, which are geographic, and those of the filter on the grid.
#pragma once

#include <optional>
#include <vector>

#include "core/filter/clusters.hpp"
#include "core/filter/filter.hpp"
#include "core/locate/fix.hpp"
#include "core/track/track_estimate.hpp"

namespace roadfix {

/// A circle around all particles with weight; nullopt where it lies off the map.
std::optional<Prior> prior_around(const MapView& map, const Particles& particles);

/// All poses within this distance and turn of a pose; nullopt where they lie beyond the map.
std::optional<Prior> prior_near(const MapView& map, const GridPose& pose, double radius_m, Angle heading_half_width);

/// Height above the ground of the particles, where it is known, of a vehicle at that height above the sea: the weighted
/// mean. nullopt where the ground is unknown, or higher.
std::optional<double> mean_agl_m(const MapView& map, const Particles& particles, double above_sea_m);

/// The modes of a search for `features` as places to draw particles around. Their covariances are wider than those of
/// the modes, since particles move on before they are weighted.
std::vector<Proposal> proposals_of(const MapView& map, const Fix& fix, const FeatureMap& features);

/// The ellipse and the radius include the registration error of the map and that of the nadir, which is scaled like the
/// ground.
TrackCluster to_geographic(const MapView& map, const Cluster& cluster, double nadir_sigma_m);

}  // namespace roadfix
