// What a query tells of where its vehicle is.
#pragma once

#include "cli/bench/manifest.hpp"
#include "cli/bench/query.hpp"
#include "cli/evaluation/random.hpp"
#include "core/locate/map_view.hpp"
#include "core/units/angle.hpp"
#include "core/units/planar.hpp"

namespace roadfix::bench {

/// Gives the query a prior as the set describes it. `truth` is any place of the map where the query does not lie on it.
/// Leaves a frame beyond the map, which no circle around it may meet, unasked. Throws InvalidInput "prior-outside-map"
/// where none meets the map around another query.
void tell_prior(Query& query, const GridPoint& truth, Angle true_heading, const QuerySet& set, const MapView& map,
                evaluation::Random& random);

}  // namespace roadfix::bench
