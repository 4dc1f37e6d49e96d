#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <opencv2/core/utils/logger.hpp>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "cli/terminal.hpp"
#include "core/units/error.hpp"
#include "core/units/memory.hpp"

namespace {

constexpr int kFailed = 1;
constexpr int kWrongUsage = 2;

/// Whether or not standard error takes it: there is nobody else to tell, and the exit code says it too.
void complain(const std::string& text) { std::fputs(text.c_str(), stderr); }

int failed(const roadfix::Error& error) {
  complain(fmt::format("roadfix: {} [{}]\n", error.what(), error.code()));
  return kFailed;
}

/// What is printed passes through a buffer, whose end may find no room.
bool is_printed() { return std::fflush(stdout) == 0 && std::ferror(stdout) == 0; }

int failed_to_print() {
  return failed(roadfix::IoFailure(
      "output-unwritable", "the answer cannot be written to the standard output: check that its disk is not full"));
}

}  // namespace

int main(int argc, char** argv) {
  roadfix::keep_freed_memory();
  roadfix::cli::watch_signals();
  // What OpenCV has to say comes as an exception, and is said once.
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  CLI::App app(
      "Localizes UAVs by roads: builds road maps from imagery and road data, serves them, and finds where a frame was "
      "taken.",
      "roadfix");
  app.set_version_flag("--version", "roadfix " ROADFIX_VERSION);
  app.require_subcommand(1);
  roadfix::cli::add_ingest_command(app);
  roadfix::cli::add_info_command(app);
  roadfix::cli::add_verify_command(app);
  roadfix::cli::add_remove_command(app);
  roadfix::cli::add_terrain_command(app);
  roadfix::cli::add_bench_command(app);
  roadfix::cli::add_detect_command(app);
  roadfix::cli::add_export_command(app);
  roadfix::cli::add_localizability_command(app);
  roadfix::cli::add_match_command(app);
  roadfix::cli::add_fix_command(app);
  roadfix::cli::add_fly_command(app);
  roadfix::cli::add_frames_command(app);
  roadfix::cli::add_boresight_command(app);
  roadfix::cli::add_world_command(app);
  roadfix::cli::add_pairs_command(app);
  roadfix::cli::add_serve_command(app);
  try {
    app.parse(argc, argv);
    return is_printed() ? 0 : failed_to_print();
  } catch (const CLI::Success& help_or_version) {
    return app.exit(help_or_version);
  } catch (const CLI::ParseError& wrong) {
    // Of a mistyped subcommand CLI11 says that one is missing.
    const std::vector<std::string> words = app.remaining();
    if (app.get_subcommands().empty() && !words.empty() && !words.front().starts_with('-')) {
      complain(fmt::format("There is no subcommand '{}'\nRun with --help for a list.\n", words.front()));
    } else {
      app.exit(wrong);
    }
    return kWrongUsage;
  } catch (const roadfix::Error& error) {
    return failed(error);
  } catch (const std::filesystem::filesystem_error& error) {
    // Whoever asks of a path what it is seldom thinks of folders that may not be entered.
    return failed(
        roadfix::IoFailure("path-refused", fmt::format("{}: {}", error.path1().string(), error.code().message())));
  } catch (const std::exception& error) {
    if (std::ferror(stdout) != 0) return failed_to_print();  // what is longer than the buffer
    complain(fmt::format("roadfix: {}\n", error.what()));
    return kFailed;
  }
}
