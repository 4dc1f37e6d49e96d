// Whether a source lies beside the others of its map: a wrong reference system or a careless georeference moves its
// roads by a few metres to a hundred, and a map of both has each street twice.
#pragma once

#include <optional>

#include "tiles/store/map_records.hpp"

namespace roadfix {

/// Where the roads of a source fit those of the others best.
struct SourceShift {
  double east_m = 0.0;  ///< by which the source would have to be moved
  double north_m = 0.0;
  double correlation = 0.0;  ///< Pearson's, of the cells that both observed, moved so
  double correlation_in_place = 0.0;
};

/// Over shifts of up to 50 cells, in steps of two. nullopt where the source fits the others in place, hardly worse, or
/// nowhere near; where they share less than 0.25 km^2, or fit nearly as well elsewhere; and where the shift is no
/// larger than the registration errors explain (2 sigma).
std::optional<SourceShift> shift_of(const SharedEvidence& shared_evidence, double cell_m, double own_sigma_m);

}  // namespace roadfix
