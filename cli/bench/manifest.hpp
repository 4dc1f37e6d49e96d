// What `roadfix bench` is asked to do: maps to build, queries to draw, methods to compare (docs/bench.md).
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/detect/frame_image.hpp"
#include "core/detect/orthoimage.hpp"
#include "core/survey/simulate.hpp"
#include "core/units/angle.hpp"
#include "core/units/words.hpp"

namespace roadfix::bench {

struct ManifestSource {
  enum class As { kImagery, kRoads, kInvented };
  std::filesystem::path path;  ///< empty for an invented town
  As as = As::kImagery;
  std::uint64_t seed = 1;  ///< of an invented town
  double side_m = 0.0;     ///< of an invented town, which is square
};

struct ManifestMap {
  std::string name;
  std::vector<ManifestSource> sources;
  std::vector<std::filesystem::path> terrain{};  ///< elevation models of its ground; empty = it knows no heights
};

/// Shares of the imagery's rows and columns, measured from its edges, that no footprint may touch.
struct Exclusion {
  double top = 0.0;
  double bottom = 0.0;
  double left = 0.0;
  double right = 0.0;
};

/// From which each query draws its quality, every property uniformly between the two.
struct QualityRange {
  FeatureQuality low;
  FeatureQuality high;
};

struct QuerySet {
  enum class Kind { kImage, kFrames, kSimulated };
  Kind kind = Kind::kImage;
  std::string map;
  std::filesystem::path path;  ///< imagery, or the CSV of the frames; empty for simulated queries
  int count = 0;               ///< ignored for frames: all are used
  Footprint footprint;         ///< ignored for frames
  Exclusion exclude;
  QualityRange noise;             ///< of simulated queries
  std::string from;               ///< map that simulated feature maps are cut out of; `map` by default
  bool elsewhere = false;         ///< the queries show ground that is not on the map: every fix is a false one
  Border border = Border::kSeen;  ///< of frames
  int together = 1;  ///< each frame with so many less one of its sequence before it, laid together by their true poses
  std::optional<double> prior_radius_m;      ///< nullopt = the whole map
  std::optional<double> prior_beyond_m;      ///< the truth is so far outside of that circle; nullopt = it is inside
  std::optional<Angle> prior_heading_range;  ///< on both sides of a heading that is told, and holds the true one
  double prior_scale_range = 0.0;            ///< how well the size of the ground is known: SearchOptions::scale_range
};

enum class MethodName { kRoads, kSift, kOrb };
inline constexpr std::array<Word<MethodName>, 3> kMethodNames{
    {{"roads", MethodName::kRoads}, {"sift", MethodName::kSift}, {"orb", MethodName::kOrb}}};
constexpr std::string_view to_string(MethodName name) { return word_of(kMethodNames, name); }

struct Manifest {
  std::vector<ManifestMap> maps;
  std::vector<QuerySet> queries;
  std::vector<MethodName> methods;
};

/// Relative paths are taken from `directory`. Throws InvalidInput that names the field ("queries[2].count").
Manifest parse_manifest(std::string_view json, const std::filesystem::path& directory);
Manifest read_manifest(const std::filesystem::path& file);

/// The manifest with only these of its methods, separated by commas. Throws InvalidInput "method-unknown".
Manifest with_methods(Manifest manifest, std::string_view names);

}  // namespace roadfix::bench
