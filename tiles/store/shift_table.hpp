// Which sources of a map file are shifted against the others (table roadfix_shifts). Shared by reader, writer and
// verifier; not for other modules.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "tiles/store/map_records.hpp"
#include "tiles/store/sqlite.hpp"

namespace roadfix {

/// Records, as part of the caller's transaction, that put_shifts() has to be called again: see
/// MapWriter::shifts_outdated().
void mark_shifts_outdated(sqlite::Connection& map);
bool shifts_outdated(sqlite::Connection& map);

/// Of sources in force, by name; nullopt for one that fits the others, or for which that cannot be decided. Shifts are
/// no longer outdated then.
void put_shifts(sqlite::Connection& map, const std::map<std::string, std::optional<SourceShift>>& shifts);

/// Of sources in force, by their names.
std::map<std::string, SourceShift> read_shifts(sqlite::Connection& map);

/// SQL for the registration error that counts of a source `s`: what it states, or what its shift says where that is
/// more.
inline constexpr std::string_view kRegistrationInForce =
    "max(s.registration_sigma_m, coalesce((SELECT sigma_m FROM roadfix_shifts h WHERE h.source_id = s.id), 0))";

/// Keeps the registration error of a source that is about to be taken out, since tiles show the source until they are
/// fused anew. Part of the caller's transaction, before it queues those tiles.
void remember_error_of_removed(sqlite::Connection& map, std::int64_t source_id);

/// The largest error so remembered, m (1 sigma per axis); 0 where no tile waits.
double error_of_removed_m(sqlite::Connection& map);

}  // namespace roadfix
