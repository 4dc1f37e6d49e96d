// The whole bench: maps, queries, methods, in the order of the manifest.
#pragma once

#include <filesystem>
#include <functional>

#include "cli/bench/map_builder.hpp"
#include "cli/bench/report.hpp"
#include "cli/bench/roads_method.hpp"
#include "core/detect/detectors.hpp"

namespace roadfix::bench {

struct BenchOptions {
  std::uint64_t seed = 1;
  int limit = 0;  ///< at most so many queries of each set; 0 = all
  int jobs = 1;   ///< queries answered at a time; times of one query then include waiting for processors
  MapBuilding maps;
  const Detectors* detectors = nullptr;  ///< of frames
  FixOptions fix;
  std::filesystem::path pictures;  ///< folder for a picture of every query and method; empty = none
  std::function<void(const std::string& task, std::int64_t done, std::int64_t total)> progress;
  std::function<void(const std::string& why)> left_out;  ///< told of each set and each frame that cannot be asked
};

/// Of the queries that could be asked. Throws IoFailure "result-unwritable", Interrupted "work-stopped" when
/// maps.stop is requested.
std::vector<SetResult> run(const Manifest& manifest, const BenchOptions& options);

}  // namespace roadfix::bench
