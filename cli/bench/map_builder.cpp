#include "cli/bench/map_builder.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/units/file_beside.hpp"
#include "core/units/fnv.hpp"
#include "tiles/imagery/elevation_models.hpp"
#include "tiles/imagery/read_orthoimage.hpp"
#include "tiles/pipeline/ingest.hpp"
#include "tiles/pipeline/open_source.hpp"
#include "tiles/sources/fingerprint.hpp"
#include "tiles/store/map_reader.hpp"
#include "tiles/store/map_writer.hpp"
#include "tiles/view/map_file_view.hpp"
#include "tiles/world/road_truth.hpp"
#include "tiles/world/street_network.hpp"

namespace roadfix::bench {
namespace {

/// The roads of an invented town, written anew each time: another version of the program may invent others.
std::filesystem::path invented_roads(const ManifestSource& source, const std::filesystem::path& cache) {
  world::WorldSettings settings;
  settings.seed = source.seed;
  settings.width_m = settings.height_m = source.side_m;
  world::Plan plan;
  plan.width_m = plan.height_m = source.side_m;
  world::Random random(source.seed, 0);
  world::invent_streets(plan, random);
  std::filesystem::path file = cache / fmt::format("invented-{}-{:g}.geojson", source.seed, source.side_m);
  FileBeside roads(file);
  world::write_road_truth(roads.unfinished().string(), plan.streets, world::place(settings, world::kDefaultCentre));
  roads.finish();
  return file;
}

SourceRequest request_of(const ManifestSource& source, const std::filesystem::path& cache) {
  SourceRequest request;
  if (source.as == ManifestSource::As::kInvented) {
    request.files = find_source(invented_roads(source, cache).string(), SourceContent::kRoads);
    return request;
  }
  const bool is_imagery = source.as == ManifestSource::As::kImagery;
  request.files = find_source(source.path.string(), is_imagery ? SourceContent::kImagery : SourceContent::kRoads);
  return request;
}

struct OpenedSource {
  std::unique_ptr<CellSource> cells;
  SourceRecord record;
};

OpenedSource open(const SourceRequest& request, int number, const MapSettings& settings, const MapBuilding& building) {
  OpenedSource source;
  source.cells = open_source(request, settings, building.detector);
  source.record = record_of(request.files, source.cells->summary(), building.seed);
  // Numbered, since files of several folders may share a stem.
  source.record.name = fmt::format("{} {}", number, request.files.name);
  return source;
}

/// Tells content and settings of all sources apart: two manifests may call different maps the same.
std::filesystem::path file_of(const ManifestMap& map, const MapSettings& settings,
                              std::span<const OpenedSource> sources, const MapBuilding& building) {
  std::string identity = fmt::format("{} {} {}", building.version, settings.zone.epsg(), settings.cell_m);
  for (const OpenedSource& source : sources) identity += "\n" + source.record.name + " " + source.record.fingerprint;
  std::string name = map.name;
  std::ranges::replace_if(
      name, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return building.cache / fmt::format("{}-{}.gpkg", name, fnv1a64(identity));
}

/// As the manifest says now: a map that was built with other heights, or without, needs not be built anew.
void put_terrain(const ManifestMap& map, const std::filesystem::path& file, MapWriter& writer,
                 const MapBuilding& building) {
  std::vector<std::string> models;
  for (const std::filesystem::path& model : map.terrain) models.push_back(model.string());
  const std::string wanted =
      models.empty() ? "" : fmt::format("{} {}", fmt::join(models, ", "), fingerprint(models, building.version));
  const auto there = info_of(file).value().terrain;
  if (wanted == (there ? there->record.location : "")) return;
  if (models.empty()) {
    writer.remove_terrain();
    return;
  }
  const ElevationReading reading = read_elevation_models(
      models, writer.settings().zone, terrain_geometry(writer.extent(), kMostTerrainCells),
      [&](std::int64_t done, std::int64_t total) { building.progress("terrain", done, total); }, building.stop);
  writer.put_terrain(reading.terrain, {wanted, {}});
}

}  // namespace

MapView build_map(const ManifestMap& map, const MapBuilding& building) {
  std::filesystem::create_directories(building.cache);
  const MapSettings settings =
      settings_of_new_map(request_of(map.sources.front(), building.cache), building.cell_m, building.detector);
  std::vector<OpenedSource> sources;
  for (const ManifestSource& source : map.sources) {
    sources.push_back(
        open(request_of(source, building.cache), static_cast<int>(sources.size()) + 1, settings, building));
  }
  const std::filesystem::path file = file_of(map, settings, sources, building);
  {
    MapWriter writer(file, settings);
    for (const OpenedSource& source : sources) {
      const auto tell = [&](std::int64_t done, std::int64_t total) {
        building.progress(source.record.name, done, total);
      };
      ingest(*source.cells, source.record, writer,
             {.jobs = building.jobs, .seed = building.seed, .on_blocks = tell, .stop = building.stop});
    }
    put_terrain(map, file, writer, building);
  }
  constexpr std::size_t kSearchCacheBytes = std::size_t{256} << 20;  // all queries search the same map
  return view_of(std::make_shared<const MapReader>(file), map.name, kSearchCacheBytes);
}

std::vector<Orthoimage> read_imagery(const ManifestMap& map, const UtmZone& zone) {
  std::vector<Orthoimage> imagery;
  for (const ManifestSource& source : map.sources) {
    if (source.as != ManifestSource::As::kImagery) continue;
    for (const std::string& path : request_of(source, {}).files.paths) imagery.push_back(read_orthoimage(path, zone));
  }
  return imagery;
}

}  // namespace roadfix::bench
