// Each subcommand lives in a file of its own and registers itself on the application with one of these functions.
#pragma once

#include <CLI/CLI.hpp>

namespace roadfix::cli {

// A command parses its options in CLI11, does its work in the callback, writes its answer to stdout and its progress
// through cli/terminal. It reports failure by throwing; main turns exceptions into one line on stderr and exit code 1.

void add_bench_command(CLI::App& app);
void add_boresight_command(CLI::App& app);
void add_detect_command(CLI::App& app);
void add_export_command(CLI::App& app);
void add_fix_command(CLI::App& app);
void add_fly_command(CLI::App& app);
void add_frames_command(CLI::App& app);
void add_info_command(CLI::App& app);
void add_ingest_command(CLI::App& app);
void add_localizability_command(CLI::App& app);
void add_match_command(CLI::App& app);
void add_pairs_command(CLI::App& app);
void add_remove_command(CLI::App& app);
void add_serve_command(CLI::App& app);
void add_terrain_command(CLI::App& app);
void add_verify_command(CLI::App& app);
void add_world_command(CLI::App& app);

}  // namespace roadfix::cli
