// What people are told of places before the flight.
#pragma once

#include <array>

#include "core/locate/localizability.hpp"
#include "core/units/words.hpp"

namespace roadfix::cli {

inline constexpr std::array<Word<PlaceKind>, 4> kMeanings{
    {{"a frame gives a fix", PlaceKind::kDistinct},
     {"its roads fit elsewhere, too, or are too few to be sure: no fix, but a track may go on", PlaceKind::kSparse},
     {"it shows hardly any road: no fix, and a track has odometry alone", PlaceKind::kBare},
     {"half or more of it is not on the map: odometry alone", PlaceKind::kUnknown}}};

}  // namespace roadfix::cli
