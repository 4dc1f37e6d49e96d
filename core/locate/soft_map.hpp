// What searches and tracks compare: not probabilities but half their log odds (core/match/soft_cells.hpp). A
// detector is less sure of roads in a picture of another day, and those that it doubts tell places apart too:
// docs/calibration-history.md has the measurement. Coarser cells are averaged after the log odds are halved, not
// before: otherwise every road would become wider.
//
// Equations (5) and (7) are the paper's and use the cells as they are.
#pragma once

#include "core/grid/feature_map.hpp"
#include "core/locate/map_view.hpp"
#include "core/search/search.hpp"

namespace roadfix {

/// Reads `map` as half its log odds for a search with finest cells of `finest_cell_m`. Coarser cells are kept in
/// MapView::searches, so all searches that share it must read through such a reader.
GridReader soft_reader(const MapView& map, double finest_cell_m);
/// `map` as half its log odds, without MapView::searches.
MapView soft_view(const MapView& map);
/// The feature map as half its log odds.
FeatureMap softened(FeatureMap features);

}  // namespace roadfix
