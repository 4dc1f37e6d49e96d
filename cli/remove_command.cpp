#include <fmt/format.h>

#include <memory>
#include <string>

#include "cli/command.hpp"
#include "cli/terminal.hpp"
#include "tiles/pipeline/remove_source.hpp"
#include "tiles/store/map_writer.hpp"

namespace roadfix::cli {
namespace {

struct RemoveArguments {
  std::string map;
  std::string source;
};

RemoveReport remove_with_progress(MapWriter& writer, const std::string& source) {
  Progress fusing("fusing", "tiles");
  Progress comparing("comparing", "sources");
  return remove_source(writer, source, fusing.updates(), comparing.updates(), stop_on_signals());
}

void run_remove(const RemoveArguments& options) {
  MapWriter writer = MapWriter::existing(options.map);
  const RemoveReport report = remove_with_progress(writer, options.source);
  fmt::print("{}: source '{}' {}\n", options.map, options.source,
             report.was_there ? "is removed" : "was not there any more; what was left to do is done");
  for (const std::string& note : report.shifts.notes) fmt::print(stderr, "note: {}\n", note);
}

}  // namespace

void add_remove_command(CLI::App& app) {
  auto* command = app.add_subcommand("remove", "Takes a source out of a map");
  command->footer(
      "Example: roadfix remove adiyaman.gpkg before\nThe map is then as if the source had never been ingested. roadfix "
      "info lists the sources. To resume after an interruption, run the same command again.");
  const auto options = std::make_shared<RemoveArguments>();
  command->add_option("map", options->map, "Map file (GeoPackage)")->required();
  command->add_option("source", options->source, "Name of the source")->required();
  command->callback([options] { run_remove(*options); });
}

}  // namespace roadfix::cli
