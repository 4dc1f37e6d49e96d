#include "tiles/world/world_files.hpp"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <system_error>
#include <vector>

#include "core/units/error.hpp"

namespace roadfix::world {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

void write_json(const fs::path& file, const ordered_json& json) {
  std::ofstream out(file);
  out << json.dump(2, ' ', false, ordered_json::error_handler_t::replace) << '\n';
  if (!out.flush()) throw IoFailure("result-unwritable", fmt::format("{}: cannot be written", file.string()));
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error) return;
  throw IoFailure("result-unwritable",
                  fmt::format("'{}': no folder can be made there ({})", folder.string(), error.message()));
}

void remove_file(const fs::path& file) {
  std::error_code error;
  fs::remove(file, error);
  if (!error) return;
  throw IoFailure("result-unwritable", fmt::format("{}: cannot be replaced ({})", file.string(), error.message()));
}

bool is_frame(const fs::path& file) {
  static const std::regex kName("frame_[0-9]+\\.png");
  return std::regex_match(file.filename().string(), kName);
}

}  // namespace

void clear_folder(const fs::path& folder) {
  make_folder(folder);
  make_folder(folder / "frames");
  // world.json first: it says that the others belong together.
  for (const char* name : {"world.json", "bench.json", "pre.tif", "post.tif", "roads.geojson", "frames/frames.csv"}) {
    remove_file(folder / name);
  }
  std::vector<fs::path> frames;
  for (const auto& entry : fs::directory_iterator(folder / "frames")) {
    if (is_frame(entry.path())) frames.push_back(entry.path());
  }
  for (const fs::path& frame : frames) remove_file(frame);
}

void write_bench_manifest(const fs::path& folder) {
  write_json(folder / "bench.json",
             {{"maps", {{{"name", "before"}, {"sources", {{{"path", "pre.tif"}, {"as", "imagery"}}}}}}},
              {"queries", {{{"map", "before"}, {"frames", "frames/frames.csv"}}}},
              {"methods", {"roads", "sift", "orb"}}});
}

void write_report(const WorldReport& report, const WorldSettings& settings, const fs::path& folder) {
  const Placement& placement = report.placement;
  const LatLon centre = placement.zone.unproject(placement.point_of(placement.cols / 2.0, placement.rows / 2.0));
  write_json(folder / "world.json",
             {{"seed", settings.seed},
              {"land", settings.land == Land::kCountry ? "country" : "town"},
              {"size_m", {placement.cols * settings.gsd_m, placement.rows * settings.gsd_m}},
              {"gsd_m", settings.gsd_m},
              {"centre", {{"lat", centre.lat_deg}, {"lon", centre.lon_deg}}},
              {"epsg", placement.zone.epsg()},
              {"roads_from", settings.roads.empty() ? "invented" : fs::path(settings.roads).filename().string()},
              {"road_lines", report.road_lines},
              {"road_km", report.road_km},
              {"blocks", report.blocks},
              {"buildings", report.buildings},
              {"collapsed", report.collapsed},
              {"trees", report.trees},
              {"varied", settings.varied},
              {"frames", report.frames},
              {"footprint_m", settings.footprint_m}});
}

void throw_if_stopped(const std::stop_token& stop) {
  if (!stop.stop_requested()) return;
  throw Interrupted("work-stopped",
                    "stopped: the folder holds an unfinished world, without world.json. Start the same command again");
}

}  // namespace roadfix::world
