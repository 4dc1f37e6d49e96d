// Whether a source lies beside the others of its map: a wrong reference system or a careless georeference moves its
// roads by a few metres to a hundred, and a map of both has each street twice.
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

/// Over shifts of up to 50 cells, in steps of two. nullopt where the source fits the others in place, hardly worse, or
/// nowhere near; where they share less than 0.25 km^2, or fit nearly as well elsewhere; and where the shift is no
/// larger than the registration errors explain (2 sigma).
///
/// Which side is right, nobody knows, and a fix may lie on either: it is as likely as not off by the whole shift. Hence
/// `sigma_m`, half of its length per axis: the 95 % ellipse around a place on the one side holds that on the other.
std::optional<SourceShift> shift_of(const SharedEvidence& shared_evidence, double cell_m);

struct ShiftReport {
  struct Beside {
    SourceShift shift;
    double stated_sigma_m = 0.0;  ///< the registration error that the source states

    friend bool operator==(const Beside&, const Beside&) = default;
  };
  std::map<std::string, Beside> beside;   ///< of the sources that lie beside the others
  std::map<std::string, Witness> copies;  ///< of the sources that have any: see Witnesses::Around
  std::vector<std::string> notes;         ///< why others could not be measured
};

/// Measures these sources in force anew, each beside those that are no copies of it, and tells the map. Of one that
/// cannot be measured, since evidence is damaged, the map keeps what it knew. `progress` counts sources, where there
/// are several. Throws Interrupted "work-stopped", and tells the map nothing then: the next command measures all.
ShiftReport measure_shifts(MapWriter& writer, const std::set<std::string>& sources, const OnProgress& progress = {},
                           const std::stop_token& stop = {});

}  // namespace roadfix
