#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "cli/number_checks.hpp"
#include "cli/output_file.hpp"
#include "cli/terminal.hpp"
#include "cli/word_option.hpp"
#include "tiles/world/real_streets.hpp"
#include "tiles/world/world.hpp"

namespace roadfix::cli {
namespace {

struct WorldArguments {
  world::WorldSettings settings;
  std::string folder;
  std::vector<double> size_km{2.0, 2.0};
  std::vector<double> centre;
};

void render(const WorldArguments& options) {
  world::WorldSettings settings = options.settings;
  settings.width_m = options.size_km[0] * 1000.0;
  settings.height_m = options.size_km[1] * 1000.0;
  require_name(options.folder);
  const std::filesystem::path truth = std::filesystem::path(options.folder) / "roads.geojson";
  require_apart({truth}, {settings.roads});
  if (std::filesystem::is_directory(settings.roads)) {
    for (const std::string& file : world::road_files(settings.roads)) require_apart({truth}, {file});
  }
  if (!options.centre.empty()) settings.centre = LatLon{options.centre[0], options.centre[1]};
  const std::stop_token stop = stop_on_signals();
  const world::WorldReport report = [&] {
    Progress progress("world", "MP", world::kTilePx * world::kTilePx / 1e6);
    return world::render_world(settings, options.folder, progress.updates(), stop);
  }();
  fmt::print(
      "{}: pre.tif and post.tif, {} x {} pixels of {:g} m in EPSG:{}\n"
      "{:.1f} km of roads, {} buildings of which {} collapsed, {} frames (seed {})\n",
      options.folder, report.placement.cols, report.placement.rows, report.placement.gsd_m,
      report.placement.zone.epsg(), report.road_km, report.buildings, report.collapsed, report.frames, settings.seed);
}

}  // namespace

void add_world_command(CLI::App& app) {
  auto* command = app.add_subcommand(
      "world", "Renders a town or open country before and after an earthquake, with the truth about its roads");
  command->footer(
      "Examples: roadfix world town\n"
      "          roadfix world goteborg --roads highways.geojson --centre 57.70,11.97 --size-km 2x1.5\n"
      "          roadfix world country --land country --varied\n"
      "Writes pre.tif, post.tif, roads.geojson, world.json, frames/ with frames.csv, and bench.json for roadfix "
      "bench, in place of an earlier world's. A folder without world.json holds an unfinished one.");
  const auto options = std::make_shared<WorldArguments>();
  world::WorldSettings& settings = options->settings;
  command->add_option("folder", options->folder, "Folder to write to, created if missing")->required();
  command->add_option("--seed", settings.seed, "The same seed gives the same world")
      ->capture_default_str()
      ->check(seed());
  constexpr std::array<Word<world::Land>, 2> kLands{{{"town", world::Land::kTown}, {"country", world::Land::kCountry}}};
  add_word_option(*command, "--land", kLands, settings.land,
                  "A town with streets and houses; or open country: woods, fields, unpaved tracks, few paved roads, "
                  "and things that look like roads (rails, streams, field margins, fire breaks)")
      ->default_str("town");
  command->add_option("--size-km", options->size_km, "Width and height in km, for example 2x2")
      ->delimiter('x')
      ->expected(2)
      ->type_name("WxH");
  command->add_option("--gsd", settings.gsd_m, "Metres per pixel")->capture_default_str();
  command->add_option("--centre,--center", options->centre, "Middle of the pictures in degrees")
      ->delimiter(',')
      ->expected(2)
      ->type_name("LAT,LON");
  command
      ->add_option(
          "--roads", settings.roads,
          "Render these roads instead of invented ones: a file of any OGR format, or a folder or ZIP archive of "
          "such files, vector tiles too")
      ->type_name("SOURCE");
  command->add_option("--collapsed", settings.collapsed_share, "Share of the buildings that fall")
      ->capture_default_str();
  command->add_flag("--varied", settings.varied, "Choose sun, air, season and camera at random, for training data");
  command->add_option("--frames", settings.frames, "Frames to cut out of post.tif")->capture_default_str();
  command->add_option("--footprint-m", settings.footprint_m, "Side of the ground that a frame shows")
      ->capture_default_str();
  command->callback([options] { render(*options); });
}

}  // namespace roadfix::cli
