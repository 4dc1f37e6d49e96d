// What a refusal of SQLite means for a map file. Shared within the store; not for other modules.
#pragma once

#include <exception>
#include <filesystem>
#include <string>

#include "tiles/store/sqlite.hpp"

namespace roadfix {

/// Code of the IoFailure for sqlite::Failure::kNeedsRecovery.
inline constexpr const char* kMapNeedsRecovery = "map-needs-recovery";

/// InvalidInput ("map-not-ours"), CorruptData ("map-corrupt"), InUse ("map-busy") or IoFailure
/// ("map-needs-recovery", "map-not-writable", "disk-full", "map-io").
std::exception_ptr map_error(const std::filesystem::path& map, sqlite::Failure failure, const std::string& detail);

}  // namespace roadfix
