// The maps of a manifest, built with the ingest pipeline and kept in a cache folder: a second run finds them done.
#pragma once

#include <filesystem>
#include <functional>
#include <stop_token>
#include <string>
#include <vector>

#include "cli/bench/manifest.hpp"
#include "core/detect/orthoimage.hpp"
#include "core/detect/road_detector.hpp"
#include "core/locate/map_view.hpp"

namespace roadfix::bench {

struct MapBuilding {
  const RoadDetector* detector = nullptr;  ///< of imagery
  double cell_m = 2.0;
  std::uint64_t seed = 1;
  int jobs = 1;
  std::filesystem::path cache;
  /// Called with the source's name before its blocks, then with (name, done, total).
  std::function<void(const std::string& source, std::int64_t done, std::int64_t total)> progress;
  std::stop_token stop;
  std::string version;  ///< of the program: another one may make other maps of the same sources
};

/// The file's name tells sources, their content, the detector and its settings, cell size, seed and version of the
/// program apart; heights of the ground are put into it as the manifest has them. Throws what sources, pipeline and
/// store throw.
MapView build_map(const ManifestMap& map, const MapBuilding& building);

/// The rasters of the map's imagery sources.
std::vector<Orthoimage> read_imagery(const ManifestMap& map, const UtmZone& zone);

}  // namespace roadfix::bench
