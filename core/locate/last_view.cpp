#include "core/locate/last_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/units/fnv.hpp"

namespace roadfix {
namespace {

// A simulator that hovers draws one picture again and again, with odometry that may tremble.
constexpr double kMovedM = 1.0;
constexpr double kTurnedRad = 0.01;

bool shows_road(const FeatureMap& features) {
  return std::ranges::any_of(features.cells.cells(),
                             [](Cell cell) { return is_observed(cell) && probability(cell) > 0.5; });
}

std::uint64_t digest_of(const FeatureMap& features) {
  const auto cells = features.cells.cells();
  Fnv1a64 hash;
  hash.add(fmt::format("{} {}", features.cells.cols(), features.cell_m));
  hash.add({reinterpret_cast<const char*>(cells.data()), cells.size()});
  return hash.value();
}

}  // namespace

bool has_moved(double moved_m, double turned_rad) { return moved_m >= kMovedM || turned_rad >= kTurnedRad; }

bool is_same_view(const FeatureMap& a, const FeatureMap& b) {
  return a.cell_m == b.cell_m && a.cells == b.cells && shows_road(a);
}

void LastView::move(const std::optional<Odometry>& odometry) {
  moved_m += odometry ? distance_m(*odometry) : kMovedM;
  turned_rad += odometry ? std::abs(odometry->turn.radians()) : 0.0;
}

bool LastView::sees_again(const FeatureMap& features) {
  const std::uint64_t seen = shows_road(features) ? digest_of(features) : 0;
  if (seen == 0 || seen != digest) *this = {seen, 0.0, 0.0};
  return has_moved(moved_m, turned_rad);
}

}  // namespace roadfix
