#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "cli/ingest/ingest_report.hpp"
#include "cli/ingest/road_options.hpp"
#include "cli/output_file.hpp"
#include "cli/terminal.hpp"
#include "cli/threads_option.hpp"
#include "core/units/error.hpp"
#include "core/units/file.hpp"
#include "core/units/parallel_for.hpp"
#include "tiles/imagery/read_orthoimage.hpp"
#include "tiles/pipeline/open_source.hpp"
#include "tiles/pipeline/training_pairs.hpp"

namespace roadfix::cli {
namespace {

namespace fs = std::filesystem;

struct PairsArguments {
  std::string imagery;
  std::string roads;
  std::string folder;
  std::string name;
  RasterOptions raster;
  std::string collar;
  RoadArguments lines;
  std::optional<double> gsd_m;
  int side_px = 1024;
  int jobs = 1;
};

/// Both sides of the pairs, and what they are told to be.
struct Ground {
  std::string name;
  std::unique_ptr<Mosaic> imagery;
  std::unique_ptr<CellSource> roads;
  double gsd_m = 0.0;
};

std::unique_ptr<CellSource> open_roads(const PairsArguments& arguments, const MapSettings& lattice,
                                       const std::stop_token& stop) {
  SourceRequest roads;
  roads.files = find_source(arguments.roads, SourceContent::kRoads, arguments.lines.lines.layer);
  roads.vectors = arguments.lines.lines;
  roads.rules = rules_of(arguments.lines);
  roads.raster.crs = roads.vectors.crs;
  if (roads.files.kind != SourceKind::kRoadVectors) refuse_for_pixels(arguments.lines, roads.files.location);
  Progress reading(fmt::format("reading {}", roads.files.name), "%", 0.1);
  roads.vectors.on_reading = reading.updates_if_long();
  roads.vectors.stop = stop;
  std::unique_ptr<CellSource> source = open_source(roads, lattice, nullptr);
  print_notes(roads.files, source->summary().notes);
  return source;
}

Ground open_ground(const PairsArguments& arguments, const std::stop_token& stop) {
  const SourceFiles pictures = find_source(arguments.imagery, SourceContent::kImagery);
  RasterOptions raster = arguments.raster;
  if (!arguments.collar.empty()) raster.collar = parse_colour(arguments.collar);
  const UtmZone zone = zone_of_image(pictures.paths.front(), raster);
  auto imagery = std::make_unique<Mosaic>(pictures.paths, raster, ValueRule::kPicture, zone);
  print_notes(pictures, imagery->band_notes());
  const double gsd_m = arguments.gsd_m.value_or(pair_gsd_m(imagery->gsd_m()));
  std::unique_ptr<CellSource> roads = open_roads(arguments, {zone, gsd_m}, stop);
  return {arguments.name.empty() ? pictures.name : arguments.name, std::move(imagery), std::move(roads), gsd_m};
}

/// Also of "my-city/" and of ".".
std::string name_of(const fs::path& folder) {
  const fs::path path = fs::absolute(folder).lexically_normal();
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

fs::path description_in(const fs::path& folder) { return folder / "pairs.json"; }

void require_same_cut(const fs::path& folder, double gsd_m, int side_px) {
  const fs::path file = description_in(folder);
  const std::optional<std::string> text = read_file(file);
  if (!text) return;
  using Place = nlohmann::json::json_pointer;
  const nlohmann::json known = nlohmann::json::parse(*text, nullptr, false);
  const auto says = [&](const Place& place, double value) {
    return !known.is_discarded() && known.contains(place) && known[place] == value;
  };
  if (says(Place("/sets/0/gsd_m"), gsd_m) && says(Place("/side_px"), side_px)) return;
  throw InvalidInput("pairs-of-another-cut",
                     fmt::format("{} does not say that its pairs are squares of {} pixels of {} m, as those that are "
                                 "asked for: name another folder, or give the same --side-px and --gsd",
                                 file.string(), side_px, gsd_m));
}

/// Says how the pairs are to be read, as models/README.md describes it, unless it is there: users add to it.
void describe_pairs(const fs::path& folder, double gsd_m, int side_px) {
  if (fs::exists(description_in(folder))) return;
  const nlohmann::ordered_json set{{"name", name_of(folder)}, {"images", "images"}, {"masks", "masks"},
                                   {"gsd_m", gsd_m},          {"label", "surface"}, {"nodata", "black"}};
  const nlohmann::ordered_json all{{"side_px", side_px}, {"sets", {set}}};
  write_file(description_in(folder), all.dump(2) + "\n");
}

void write_png(const fs::path& file, const cv::Mat& image) {
  std::vector<std::uint8_t> png;
  cv::imencode(".png", image, png);
  write_file(file, {reinterpret_cast<const char*>(png.data()), png.size()});
}

constexpr double kLeastSeen = 0.02;  // of a square that is written

struct Written {
  std::int64_t pairs = 0;
  double most_seen = 0.0;  ///< of a square
  double seen_km2 = 0.0;
  double road_km2 = 0.0;
};

/// Named after the metres east and north of their north-western corners, so that other days of the ground have equal
/// names up to that of the imagery.
Written write_pairs(const PairsArguments& arguments, const Ground& ground, const std::vector<GridGeometry>& squares,
                    const std::stop_token& stop) {
  Progress progress(ground.name, "MP", static_cast<double>(arguments.side_px) * arguments.side_px / 1e6);
  const fs::path folder(arguments.folder);
  Written written;
  std::once_flag described;
  std::mutex mutex;
  std::int64_t done = 0;
  const auto total = static_cast<int>(squares.size());
  progress.update(0, total);
  parallel_for(total, arguments.jobs, [&](int i) {
    if (stop.stop_requested()) return;
    const GridGeometry& square = squares[static_cast<std::size_t>(i)];
    const TrainingPair pair = training_pair(*ground.imagery, *ground.roads, square);
    const GridBox box = square.box();
    if (pair.seen >= kLeastSeen) {
      const std::string name = fmt::format("{:.0f}_{:.0f}_{}.png", box.min.east_m, box.max.north_m, ground.name);
      std::call_once(described, [&] { describe_pairs(folder, ground.gsd_m, arguments.side_px); });
      write_png(folder / "images" / name, pair.picture);
      write_png(folder / "masks" / name, pair.mask);
    }
    const std::lock_guard lock(mutex);
    written.most_seen = std::max(written.most_seen, pair.seen);
    if (pair.seen >= kLeastSeen) {
      ++written.pairs;
      written.seen_km2 += pair.seen * box.width_m() * box.height_m() / 1e6;
      written.road_km2 += pair.road * box.width_m() * box.height_m() / 1e6;
    }
    progress.update(++done, total);
  });
  return written;
}

[[noreturn]] void refuse_without_ground(const PairsArguments& arguments) {
  throw InvalidInput("pairs-without-ground",
                     fmt::format("{} and {} share no ground of which both say something: look at where they are "
                                 "(gdalinfo, ogrinfo -so -al), and name their reference systems with --crs and "
                                 "--roads-crs if the files have wrong ones",
                                 arguments.imagery, arguments.roads));
}

[[noreturn]] void refuse_little_ground(const PairsArguments& arguments, double gsd_m) {
  throw InvalidInput(
      "pairs-without-ground",
      fmt::format("{} and {} share too little ground: less than {:.0f} % of each square of {:.6g} m. Give "
                  "smaller squares (--side-px, now {})",
                  arguments.imagery, arguments.roads, 100.0 * kLeastSeen, arguments.side_px * gsd_m,
                  arguments.side_px));
}

void run_pairs(const PairsArguments& arguments) {
  const std::stop_token stop = stop_on_signals();
  require_name(arguments.folder);
  const Ground ground = open_ground(arguments, stop);
  const std::vector<GridGeometry> squares =
      pair_squares(*ground.imagery, *ground.roads, ground.gsd_m, arguments.side_px);
  if (squares.empty()) refuse_without_ground(arguments);
  const fs::path folder(arguments.folder);
  require_folder(folder / "images");
  require_folder(folder / "masks");
  require_same_cut(folder, ground.gsd_m, arguments.side_px);
  const Written written = write_pairs(arguments, ground, squares, stop);
  if (stop.stop_requested()) {
    throw Interrupted("work-stopped", fmt::format("stopped after {} pairs, which are whole. The same command begins "
                                                  "anew and writes them again",
                                                  written.pairs));
  }
  if (written.most_seen == 0.0) refuse_without_ground(arguments);
  if (written.pairs == 0) refuse_little_ground(arguments, ground.gsd_m);
  fmt::print("{}: {} pairs in pixels of {} m, {:.2f} km2 seen, {:.1f} % of it road\n", arguments.folder, written.pairs,
             ground.gsd_m, written.seen_km2, 100.0 * written.road_km2 / written.seen_km2);
}

}  // namespace

void add_pairs_command(CLI::App& app) {
  auto* command =
      app.add_subcommand("pairs", "Cuts imagery and road data of the same ground into pairs to train networks on");
  command->footer(
      "Examples: roadfix pairs city.tif roads.geojson my-city\n"
      "          python3 models/train.py --pairs my-city --only-pairs --out build/mine      (models/README.md)\n"
      "Writes images/ and masks/ of equal names and pairs.json; what imagery or roads do not cover is black. "
      "Imagery of several places, or of one on several days (NAME_pre, NAME_post), may go into one folder.");
  const auto a = std::make_shared<PairsArguments>();
  command->add_option("imagery", a->imagery, "Georeferenced imagery: a file, a folder or ZIP archive of files")
      ->required();
  command->add_option("roads", a->roads, "Road data of that ground: lines, or rasters of roads")->required();
  command->add_option("folder", a->folder, "Folder to write to, created if missing")->required();
  command->add_option("--gsd", a->gsd_m, "Metres per pixel; default: about those of the imagery, 0.5 at least")
      ->check(CLI::IsMember({0.25, 0.5, 1.0, 2.0}));
  command->add_option("--side-px", a->side_px, "Side of a picture in pixels")
      ->capture_default_str()
      ->check(CLI::Range(64, 8192));
  command->add_option("--name", a->name, "End of the pictures' names; default: stem of the file, name of the folder");
  command->add_option("--crs", a->raster.crs, "Reference system of the imagery, if it has none or a wrong one");
  command->add_option("--roads-crs", a->lines.lines.crs, "Reference system of the roads, likewise");
  command->add_option("--nodata-color", a->collar,
                      "Colour of the collar around the imagery: white, black or R,G,B; for one that does not fill a "
                      "corner");
  add_road_options(*command, a->lines);
  add_threads_option(*command, "--jobs", a->jobs, "Pairs in progress at a time");
  command->callback([a] { run_pairs(*a); });
}

}  // namespace roadfix::cli
