// Before the flight: would a frame of a place give a fix? From the map alone.
#pragma once

#include "core/locate/fix.hpp"
#include "core/survey/simulate.hpp"

namespace roadfix {

/// Of the side of a footprint.
inline constexpr double kSmallestFootprintM = 20.0;
inline constexpr double kLargestFootprintM = 5000.0;

/// Less of a footprint on the map says nothing about the place.
inline constexpr double kMinObservedShare = 0.5;

struct LocalizabilityQuery {
  LatLon position;
  double footprint_m = 400.0;  ///< side of the square of ground that a frame shows
  double radius_m = 1500.0;    ///< radius of the prior: the place must be told from all others in this circle
  /// What the detector is assumed to do: about as well as over a damaged town.
  FeatureQuality quality{.erase = 0.25, .invent = 0.25};
  FixOptions fix;
};

struct Localizability {
  FixStatus status = FixStatus::kNoFix;  ///< what the frame would give; `fix` only at the place itself
  std::string reason;                    ///< as of a Fix, or "wrong-place" where the best place is another one
  std::string explanation;               ///< the reason as a sentence for an operator
  bool complete = true;         ///< false where the time limit ended the search: whatever it found, it is no fix
  double probability = 0.0;     ///< that the frame would be placed rightly; 0 where the best place is another one
  bool bare = false;            ///< the frame would show less road than a single one across it, whatever is found
  double road_share = 0.0;      ///< how much of the observed part of the footprint is road, 0 to 1
  double observed_share = 0.0;  ///< how much of the footprint the map has observed, 0 to 1
  std::vector<FixMode> alike;   ///< other places that fit, best first
};

/// What a frame of a place would be worth.
enum class PlaceKind {
  kDistinct,  ///< it would give a fix
  kSparse,    ///< it shows roads, but they fit elsewhere, too, or are too few to be sure
  kBare,      ///< it shows less road than a single one across it
  kUnknown,   ///< the map has observed too little of the footprint to say
};

PlaceKind kind_of(const Localizability& place);

/// Cuts the footprint out of the map, north up, makes it as bad as the quality says (always with the same generator),
/// and looks for it around the place at every heading. Throws what locate() throws, and InvalidInput
/// "parameter-out-of-range".
Localizability localizability(const MapView& map, const LocalizabilityQuery& query);

}  // namespace roadfix
