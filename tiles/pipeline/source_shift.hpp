// Whether a source is shifted against the others of its map: a wrong reference system or a careless georeference moves
// its roads by a few metres to a hundred, and a map of both has each street twice.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <vector>

#include "core/units/progress.hpp"
#include "tiles/store/map_records.hpp"
#include "tiles/store/map_writer.hpp"

namespace roadfix {

/// Tries shifts of up to 50 cells, in steps of two. nullopt where the source fits in place, or hardly worse than at the
/// best shift; where no shift in reach fits, or several do about as well; where they share less than 0.25 km^2; and
/// where the registration errors explain the shift (2 sigma).
///
/// Nobody knows which side is right, and a fix may follow either: it is as likely as not off by the whole shift. Hence
/// `sigma_m` is half the shift's length per axis: the 95 % ellipse around a place on one side holds it on the other.
std::optional<SourceShift> shift_of(const SharedEvidence& shared_evidence, double cell_m);

struct ShiftReport {
  struct Shifted {
    SourceShift shift;
    double stated_sigma_m = 0.0;  ///< the registration error that the source states

    friend bool operator==(const Shifted&, const Shifted&) = default;
  };
  std::map<std::string, Shifted> shifted;  ///< by name; sources that fit the others are not listed
  std::map<std::string, Witness> copies;   ///< by name, of sources that have copies: see Witnesses::Around
  std::vector<std::string> notes;          ///< which sources could not be measured, and why
};

/// Measures these sources in force against those that are no copies of them, and stores the result in the map. If a
/// source cannot be measured because evidence is damaged, the map keeps its last result. `progress` counts sources, if
/// there are several. Throws Interrupted "work-stopped" and stores nothing then: the next command measures all.
ShiftReport measure_shifts(MapWriter& writer, const std::set<std::string>& sources, const OnProgress& progress = {},
                           const std::stop_token& stop = {});

}  // namespace roadfix
