// The folder of a rendered world, but for its pictures and roads.
#pragma once

#include <filesystem>
#include <stop_token>

#include "tiles/world/settings.hpp"
#include "tiles/world/world.hpp"

namespace roadfix::world {

/// Makes the folder with its frames/ where they are missing, and removes what an earlier world left there. Throws
/// IoFailure "result-unwritable", as the others do.
void clear_folder(const std::filesystem::path& folder);

/// bench.json, so that the frames can be asked about at once, by every method.
void write_bench_manifest(const std::filesystem::path& folder);

/// world.json.
void write_report(const WorldReport& report, const WorldSettings& settings, const std::filesystem::path& folder);

/// Throws Interrupted "work-stopped".
void throw_if_stopped(const std::stop_token& stop);

}  // namespace roadfix::world
