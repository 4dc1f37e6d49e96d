// What `locate` lets the search compare: not probabilities but half their log odds (core/match/soft_cells.hpp). A
// detector is less sure of roads in a picture of another day, and those that it doubts tell places apart too:
// docs/experiments.md has the measurement. Coarser cells are averaged after the log odds are halved, not before:
// otherwise every road would become wider.
//
// Equation (5) of a fix and the weights of a track's particles use the cells as they are: equation (7) is the paper's,
// and measurement_model.hpp expects the correlation of plain cells.
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
