// What `locate` lets the search compare: not probabilities but half their log odds (core/match/soft_cells.hpp). A
// detector is less sure of roads in a picture of another day, and those that it doubts tell places apart too:
// docs/experiments.md has the measurement. Coarser cells hold the mean of what is compared, not what is compared of the
// mean: the latter would widen every road. Equation (5) stays of the cells as they are, and so does what weighs the
// particles of a track: equation (7) is the paper's, and the correlation that measurement_model.hpp expects is that of
// plain cells.
#pragma once

#include "core/grid/feature_map.hpp"
#include "core/locate/map_view.hpp"
#include "core/match/search.hpp"

namespace roadfix {

/// For a search in cells of `finest_cell_m`. `map` outlives the reader; coarser cells are kept in MapView::searches,
/// and every search that shares it has to read through such a reader.
GridReader compared_cells(const MapView& map, double finest_cell_m);
FeatureMap compared_cells(FeatureMap features);

}  // namespace roadfix
