// Where date, licence, attribution and registration error of a source come from: first the user, then what the map was
// told before of the same content, then the source itself.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/units/provenance.hpp"
#include "tiles/store/map_records.hpp"

namespace roadfix {

/// What the user says; an empty text says that there is none.
struct UserProvenance {
  std::optional<std::string> date = {};
  std::optional<std::string> licence = {};
  std::optional<std::string> attribution = {};
  std::optional<double> registration_sigma_m = {};
};

/// Fills in the provenance of `record`; its registration error is that of the source, unless told otherwise. `own` is
/// what the source says of itself, `told` what the user says. `before` are the records of this name in the map, the one
/// in force first: if the fingerprint is the same, what was told then is kept, unless `replace` describes the source
/// anew. Returns notes for the user on what is taken from the source, what changes, and what replacing loses.
std::vector<std::string> describe_source(SourceRecord& record, const Provenance& own, const UserProvenance& told,
                                         std::span<const SourceRecord> before, bool replace);

}  // namespace roadfix
