// Before the flight: over how much of the ground of a map does a frame tell its place?
#pragma once

#include <cstdint>

#include "core/survey/localizability.hpp"
#include "core/units/progress.hpp"

namespace roadfix {

struct SurveyOptions {
  /// Of each place; its position is not read.
  LocalizabilityQuery query;
  std::int64_t max_places = 1000;  ///< each takes about a second of one core
  int threads = 1;
  OnProgress progress{};  ///< in places
};

/// Of the places of whose footprint the map has observed half or more; of others it cannot say.
struct MapSurvey {
  double ground_m2 = 0.0;     ///< observed ground that the places stand for, each for an equal part of it
  std::int64_t distinct = 0;  ///< a frame would give a fix
  std::int64_t sparse = 0;    ///< it shows roads, but they fit elsewhere, too, or are too few to be sure
  std::int64_t bare = 0;      ///< it shows less road than a single one across it

  std::int64_t places() const { return distinct + sparse + bare; }
};

/// Asks localizability() at places about a footprint from each other all over the map's observed ground or, where those
/// are more than `max_places`, at so many of them, evenly spread. Throws what localizability() throws.
MapSurvey survey(const MapView& map, const SurveyOptions& options);

}  // namespace roadfix
