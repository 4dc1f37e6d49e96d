#include "cli/bench/map_builder.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <string_view>
#include <utility>

#include "core/units/error.hpp"
#include "tiles/pipeline/ingest.hpp"
#include "tiles/pipeline/open_source.hpp"
#include "tiles/sources/mosaic.hpp"
#include "tiles/view/map_file_view.hpp"

namespace roadfix::bench {
namespace {

SourceRequest request_of(const ManifestSource& source) {
  SourceRequest request;
  request.files = find_source(source.path.string(), parse_meaning(source.as));
  return request;
}

/// FNV-1a: the cache's names must be the same in every run and build.
std::uint64_t digest(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  return hash;
}

std::filesystem::path file_of(const ManifestMap& map, const MapBuilding& building) {
  const std::string settings = fmt::format("{} {} {}", building.detector->describe(), building.cell_m, building.seed);
  return building.cache / fmt::format("{}-{:016x}.gpkg", map.name, digest(settings));
}

void ingest_source(const ManifestSource& manifest_source, const MapSettings& settings, MapWriter& writer,
                   const MapBuilding& building) {
  const SourceRequest request = request_of(manifest_source);
  const auto source = open_source(request, settings, building.detector);
  const SourceSummary summary = source->summary();
  SourceRecord record;
  record.name = request.files.name;
  record.kind = summary.kind;
  record.location = request.files.location;
  record.fingerprint = fmt::format("{}-seed{}", summary.fingerprint, building.seed);
  record.method = summary.method;
  record.registration_sigma_m = summary.registration_sigma_m;
  const IngestProgress progress{
      [&](std::int64_t done, std::int64_t total) { building.progress(record.name, done, total); }, {}};
  ingest(*source, record, settings, writer, {building.jobs, building.seed, true}, progress, building.stop);
}

}  // namespace

MapView build_map(const ManifestMap& map, const MapBuilding& building) {
  std::filesystem::create_directories(building.cache);
  const std::filesystem::path file = file_of(map, building);
  {
    auto settings = MapWriter::settings_of(file);
    if (!settings) {
      settings.emplace(UtmZone::containing(centre_of_source(request_of(map.sources.front()))), building.cell_m);
    }
    MapWriter writer(file, *settings);
    for (const ManifestSource& source : map.sources) ingest_source(source, *settings, writer, building);
  }
  return view_of(std::make_shared<const MapReader>(file), map.name);
}

Orthoimage read_orthoimage(const std::filesystem::path& path, const UtmZone& zone) {
  constexpr double kMaxPixels = 4e8;
  const Mosaic mosaic({path.string()}, {}, ValueRule::kPicture, zone);
  const GridBox box = mosaic.extent();
  const double gsd_m = mosaic.gsd_m();
  const double pixels = box.width_m() / gsd_m * (box.height_m() / gsd_m);
  if (pixels > kMaxPixels) {
    throw LimitExceeded("imagery-too-large",
                        fmt::format("{}: {:.0f} megapixels are more than the {:.0f} that a bench can hold",
                                    path.string(), pixels / 1e6, kMaxPixels / 1e6));
  }
  return {mosaic.view(box, gsd_m), {box.min.east_m, box.max.north_m}};
}

std::vector<Orthoimage> read_imagery(const ManifestMap& map, const UtmZone& zone) {
  std::vector<Orthoimage> imagery;
  for (const ManifestSource& source : map.sources) {
    if (source.as != "imagery") continue;
    for (const std::string& path : request_of(source).files.paths) imagery.push_back(read_orthoimage(path, zone));
  }
  return imagery;
}

}  // namespace roadfix::bench
