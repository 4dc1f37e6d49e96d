#include "tiles/pipeline/open_source.hpp"

#include <fmt/format.h>

#include <cassert>

#include "core/units/error.hpp"
#include "tiles/imagery/georeference.hpp"
#include "tiles/roads/vector_roads.hpp"
#include "tiles/store/map_reader.hpp"

namespace roadfix {

LatLon centre_of_source(const SourceRequest& request) {
  const SourceFiles& files = request.files;
  if (files.kind == SourceKind::kRoadVectors) return centre_of_roads(files.paths, request.vectors);
  return centre_of(RasterFile(files.paths.front(), request.raster));
}

std::unique_ptr<CellSource> open_source(const SourceRequest& request, const MapSettings& settings,
                                        const RoadDetector* detector) {
  const SourceFiles& files = request.files;
  switch (files.kind) {
    case SourceKind::kImagery:
      assert(detector != nullptr);
      return open_imagery(files.paths, request.raster, settings.zone, settings.cell_m, *detector);
    case SourceKind::kRoadRaster:
      return open_road_raster(files.paths, request.raster, settings.zone, settings.cell_m);
    case SourceKind::kRoadVectors:
      break;
  }
  return open_road_vectors(files.paths, request.vectors, request.rules, settings.zone, settings.cell_m);
}

SourceSummary summary_of(const CellSource& source, const SourceFiles& files) {
  SourceSummary summary = source.summary();
  if (!files.is_map || files.kind != SourceKind::kRoadRaster) return summary;
  try {
    summary.told = provenance_of(MapReader(files.paths.front()).info());
  } catch (const InvalidInput& error) {
    if (error.code() == "map-from-older-version") throw;
    return summary;  // another program's that is called alike, or of a newer version: its pixels are read
  }
  if (summary.told.registration_sigma_m > 0.0) summary.registration_sigma_m = summary.told.registration_sigma_m;
  return summary;
}

SourceRecord record_of(const SourceFiles& files, const SourceSummary& summary, std::uint64_t seed) {
  return {.name = files.name,
          .content = summary.kind == SourceKind::kImagery ? SourceContent::kImagery : SourceContent::kRoads,
          .location = files.location,
          .fingerprint = fmt::format("{}-seed{}", summary.fingerprint, seed),
          .method = summary.method,
          .provenance = {.registration_sigma_m = summary.registration_sigma_m}};
}

MapSettings settings_of_new_map(const SourceRequest& first, double cell_m, const RoadDetector* detector) {
  constexpr double kNearM = 480e3;
  const LatLon centre = centre_of_source(first);
  MapSettings settings{UtmZone::containing(centre), cell_m};
  if (!settings.zone.northern() || settings.zone.project(centre).north_m > kNearM) return settings;
  const GridBox extent = open_source(first, settings, detector)->extent();
  if (extent.min.north_m < 0.0 && extent.max.north_m < kNearM) settings.zone = settings.zone.southern();
  return settings;
}

}  // namespace roadfix
