#include <fmt/format.h>

#include <memory>
#include <string>

#include "cli/command.hpp"
#include "cli/terminal.hpp"
#include "tiles/pipeline/source_shift.hpp"
#include "tiles/store/map_writer.hpp"

namespace roadfix::cli {
namespace {

struct RemoveArguments {
  std::string map;
  std::string source;
};

void remove_source(const RemoveArguments& options) {
  const std::stop_token stop = stop_on_signals();
  MapWriter writer = MapWriter::existing(options.map);
  bool was_there = false;
  {
    Progress progress("fusing", "tiles");
    was_there = writer.remove_source(options.source, progress.updates(), stop);
  }
  // It may have been what others lay beside.
  const ShiftReport shifts = measure_shifts(writer, writer.sources_in_force());
  fmt::print("{}: source '{}' {}\n", options.map, options.source,
             was_there ? "is removed" : "was not there any more; what was left to fuse is fused");
  for (const std::string& note : shifts.notes) fmt::print(stderr, "note: {}\n", note);
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
  command->callback([options] { remove_source(*options); });
}

}  // namespace roadfix::cli
