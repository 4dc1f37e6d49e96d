// Which of several frames contradict the others where they show the same ground: one of another place, with a wrong
// offset, or torn. That is told before any search and without the map, so it chooses no place and makes none likelier.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/grid/combine.hpp"

namespace roadfix {

/// Indices into `parts`, ascending: those that more of the others contradict than agree with. The most contradicted are
/// left out first, then the rest are asked again; none of those that only contradict each other, and none at all if
/// that leaves no majority.
///
/// Two frames are compared where they share at least 3600 m2 of observed ground and both show at least 0.4 times the
/// road of one street across it. They contradict each other if what searches compare (soft_map.hpp) correlates there by
/// less than 0.15, else they agree. All have cells of one size.
std::vector<std::size_t> contradicting_frames(std::span<const PlacedFeatures> parts);

}  // namespace roadfix
