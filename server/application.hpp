// The whole service from its configuration: the outermost ring, the only place that knows all of it.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>

#include "core/detect/make_detector.hpp"
#include "core/locate/calibration.hpp"
#include "server/api/limits.hpp"
#include "server/http/server.hpp"
#include "server/maps/map_registry.hpp"
#include "server/tracks/track_registry.hpp"

namespace roadfix::server {

struct Configuration {
  std::filesystem::path maps;
  std::chrono::milliseconds watch_interval{1000};
  MapCacheBytes map_cache_bytes;
  std::size_t picture_cache_bytes = std::size_t{64} << 20;
  int search_threads = 1;                                                  ///< of all searches
  std::shared_ptr<const Calibration> calibration = shipped_calibration();  ///< never nullptr
  http::ServerSettings http;
  api::Limits limits;
  std::filesystem::path tracks;  ///< file of the tracks' state; empty = tracks.sqlite in the folder of the maps
  TrackLimits track_limits;
  DetectorChoice detector;
};

class Application {
 public:
  /// Opens the maps and loads the detector. Throws what these throw.
  explicit Application(Configuration configuration);
  ~Application();
  Application(const Application&) = delete;
  Application& operator=(const Application&) = delete;

  /// Serves from now on; returns the port.
  int start();
  /// Answers what has begun, then returns.
  void stop();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace roadfix::server
