#include "core/locate/same_view.hpp"

#include <algorithm>

namespace roadfix {
namespace {

constexpr double kTurnedRad = 0.01;

}  // namespace

bool has_moved(double moved_m, double turned_rad) { return moved_m >= kMovedM || turned_rad >= kTurnedRad; }

bool has_road_cell(const FeatureMap& features) { return std::ranges::any_of(features.cells.cells(), is_road); }

bool is_same_view(const FeatureMap& a, const FeatureMap& b) {
  return a.cell_m == b.cell_m && a.cells == b.cells && has_road_cell(a);
}

}  // namespace roadfix
