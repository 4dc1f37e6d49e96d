// A map, or a region of it, as a file for other programs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stop_token>

#include "core/units/progress.hpp"
#include "tiles/store/map_reader.hpp"

namespace roadfix {

enum class ExportFormat {
  /// Cloud-optimised GeoTIFF with the overviews of the map: Float32, 0..1, nodata -1. Widened to whole cells of the
  /// coarsest of them.
  kCog,
  kGeoTiff,  ///< tiled GeoTIFF: Float32, 0..1, nodata -1
  kPng,      ///< grey 0..254 and alpha (0 = unobserved), position in a world file
  kMbTiles,  ///< the same picture in Web-Mercator tiles
};

struct ExportOptions {
  ExportFormat format = ExportFormat::kCog;
  std::optional<GridBox> box = {};    ///< in the zone of the map, widened to whole cells; the whole map if not given
  std::optional<double> cell_m = {};  ///< the map's cell size times a power of two; the map's own if not given
};

/// Written block by block beside the target and renamed at the end: whatever happens, `target` is whole or as it was
/// before. Throws InvalidInput ("region-outside-map", "cell-size-not-in-map", "map-has-no-cells"), LimitExceeded
/// ("picture-too-large": PNG above 2^29 pixels), Interrupted ("work-stopped") or IoFailure ("export-failed").
/// `progress` counts thousandths.
void export_map(const MapReader& map, const std::filesystem::path& target, const ExportOptions& options,
                const OnProgress& progress = {}, std::stop_token stop = {});

}  // namespace roadfix
