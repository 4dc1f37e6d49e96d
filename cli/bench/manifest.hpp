// What `roadfix bench` is asked to do: maps to build, queries to draw, methods to compare (docs/bench.md).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/detect/orthoimage.hpp"

namespace roadfix::bench {

struct ManifestSource {
  std::filesystem::path path;
  std::string as;  ///< "imagery" or "roads"
};

struct ManifestMap {
  std::string name;
  std::vector<ManifestSource> sources;
};

/// Shares of the imagery's rows and columns, measured from its edges, that no footprint may touch.
struct Exclusion {
  double top = 0.0;
  double bottom = 0.0;
  double left = 0.0;
  double right = 0.0;
};

/// How a simulated feature map differs from the map it was cut from.
struct FeatureNoise {
  double erase = 0.0;    ///< share of the road cells that vanish, in patches
  double invent = 0.0;   ///< road cells that appear, as a share of the true ones, as strokes
  double shift_m = 0.0;  ///< 1 sigma of a common shift per axis
};

struct QuerySet {
  enum class Kind { kImage, kFrames, kSimulated };
  Kind kind = Kind::kImage;
  std::string map;
  std::filesystem::path path;  ///< imagery, or the CSV of the frames; empty for simulated queries
  int count = 0;               ///< ignored for frames: all are used
  Footprint footprint;         ///< ignored for frames
  Exclusion exclude;
  FeatureNoise noise;
  bool black_is_unobserved = false;
  std::optional<double> prior_radius_m;  ///< nullopt = the whole map
};

struct Manifest {
  std::vector<ManifestMap> maps;
  std::vector<QuerySet> queries;
  std::vector<std::string> methods;  ///< of "roads", "sift", "orb"
};

/// Relative paths are taken from `directory`. Throws InvalidInput that names the field ("queries[2].count").
Manifest parse_manifest(std::string_view json, const std::filesystem::path& directory);
Manifest read_manifest(const std::filesystem::path& file);

}  // namespace roadfix::bench
