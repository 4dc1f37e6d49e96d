// What a command was asked for, kept with its results: nobody can repeat a measurement from its figures alone.
#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json_fwd.hpp>

namespace roadfix::cli {

/// Each option that was given, by its name, with its values as they were written.
nlohmann::json given_options(const CLI::App& command);

}  // namespace roadfix::cli
