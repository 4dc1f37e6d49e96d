// Which sources of a map file lie beside the others (table roadfix_shifts). Shared by reader, writer and verifier; not
// for other modules.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "tiles/store/map_records.hpp"
#include "tiles/store/sqlite.hpp"

namespace roadfix {

/// Says, as part of the caller's transaction, that the sources in force are others than those that were measured.
void call_shifts_outdated(sqlite::Connection& map);
bool shifts_outdated(sqlite::Connection& map);

/// Of sources in force, by their names; nullopt for one that fits the others, or of which that cannot be told. From
/// then on they count as measured.
void put_shifts(sqlite::Connection& map, const std::map<std::string, std::optional<SourceShift>>& shifts);

/// Of sources in force, by their names.
std::map<std::string, SourceShift> read_shifts(sqlite::Connection& map);

/// SQL for the registration error that counts of a source `s`: what it states, or what its shift says where that is
/// more.
inline constexpr std::string_view kRegistrationInForce =
    "max(s.registration_sigma_m, coalesce((SELECT sigma_m FROM roadfix_shifts h WHERE h.source_id = s.id), 0))";

/// Says, as part of the caller's transaction and before tiles wait for it, that a source is taken out: until they are
/// fused they show it, as far off as it lies.
void remember_error_of_removed(sqlite::Connection& map, std::int64_t source_id);

/// The largest error so remembered, m (1 sigma per axis); 0 where no tile waits.
double error_of_removed_m(sqlite::Connection& map);

}  // namespace roadfix
