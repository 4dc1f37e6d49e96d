#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "cli/terminal.hpp"
#include "core/units/error.hpp"
#include "core/units/json_text.hpp"
#include "tiles/store/map_verifier.hpp"
#include "tiles/store/map_writer.hpp"

namespace roadfix::cli {
namespace {

using nlohmann::json;

struct VerifyArguments {
  std::string map;
  bool as_json = false;
  bool repair = false;
};

void print_json(const std::string& path, const MapVerdict& verdict) {
  json problems = json::array();
  for (const MapProblem& problem : verdict.problems)
    problems.push_back({{"code", problem.code}, {"what", problem.what}});
  json unfinished = json::array();
  for (const SourceStatus& source : verdict.unfinished) unfinished.push_back(source.record.name);
  const json answer = {{"map", path},
                       {"whole", verdict.problems.empty()},
                       {"tiles", verdict.tiles},
                       {"evidence_tiles", verdict.evidence},
                       {"unfinished_sources", unfinished},
                       {"tiles_to_fuse", verdict.tiles_to_fuse},
                       {"problems", problems}};
  fmt::print("{}\n", json_text(answer, 2));
}

void print_text(const std::string& path, const MapVerdict& verdict) {
  for (const MapProblem& problem : verdict.problems) fmt::print("{} [{}]\n", problem.what, problem.code);
  if (verdict.problems.empty()) {
    fmt::print("{}: whole ({} tiles, {} tiles of evidence){}\n", path, verdict.tiles, verdict.evidence,
               verdict.tiles == 0 ? ", but empty: no ground is observed yet" : "");
  }
  for (const SourceStatus& source : verdict.unfinished) {
    fmt::print("source '{}' is not finished: {} of {} blocks. Repeat its ingest to go on\n", source.record.name,
               source.blocks_done, source.blocks_total);
  }
  if (verdict.tiles_to_fuse > 0) {
    fmt::print("{} tiles do not show their newest evidence yet: a command was interrupted. Repeat it\n",
               verdict.tiles_to_fuse);
  }
}

void repair(const std::string& path, const std::stop_token& stop) {
  MapWriter writer = MapWriter::existing(path);
  std::vector<std::string> lost;
  {
    Progress progress("repair", "tiles");
    lost = writer.repair(progress.updates(), stop);
  }
  for (const std::string& source : lost) {
    fmt::print(stderr, "source '{}' had damaged evidence, which was dropped: ingest it again with --replace\n", source);
  }
  for (const std::string& what : writer.repair_terrain()) {
    fmt::print(stderr, "{}; that was dropped: write the terrain anew with roadfix terrain\n", what);
  }
}

void verify(const VerifyArguments& options) {
  const std::stop_token stop = stop_on_signals();
  if (options.repair) repair(options.map, stop);
  MapVerdict verdict;
  {
    Progress progress("verify", "tiles");
    verdict = verify_map(options.map, progress.updates(), stop);
  }
  options.as_json ? print_json(options.map, verdict) : print_text(options.map, verdict);
  if (!verdict.problems.empty()) {
    throw CorruptData("map-damaged", fmt::format("{}: {} problem{} found", options.map, verdict.problems.size(),
                                                 verdict.problems.size() == 1 ? "" : "s"));
  }
}

}  // namespace

void add_verify_command(CLI::App& app) {
  auto* command = app.add_subcommand("verify", "Checks that every tile of a map is intact and agrees with its sources");
  command->footer(
      "Example: roadfix verify adiyaman.gpkg\nExit code 0: whole, 1: damaged (each problem on a line). Interrupted "
      "ingests are reported with what is left to do; they are not damage.");
  const auto options = std::make_shared<VerifyArguments>();
  command->add_option("map", options->map, "Map file (GeoPackage)")->required();
  command->add_flag("--json", options->as_json, "Answer in JSON");
  command->add_flag(
      "--repair", options->repair,
      "First rebuild all tiles from the evidence of the sources; damaged evidence is dropped and reported");
  command->callback([options] { verify(*options); });
}

}  // namespace roadfix::cli
