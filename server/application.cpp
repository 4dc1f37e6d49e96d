#include "server/application.hpp"

#include <spdlog/spdlog.h>

#include <utility>

#include "core/units/error.hpp"
#include "server/api/problem.hpp"
#include "server/maps/map_registry.hpp"
#include "server/maps/picture_cache.hpp"
#include "server/service.hpp"

namespace roadfix::server {
namespace {

/// Faults of the service reach its log whole; the client learns only what it can act on.
http::Response error_response(std::exception_ptr thrown) {
  http::Response response = api::problem(thrown);
  if (response.status != 500) return response;
  try {
    std::rethrow_exception(std::move(thrown));
  } catch (const Error& error) {
    spdlog::error("a request failed: {} [{}]", error.what(), error.code());
  } catch (const std::exception& error) {
    spdlog::error("a request failed: {}", error.what());
  }
  return response;
}

}  // namespace

struct Application::Parts {
  explicit Parts(Configuration c)
      : configuration(std::move(c)),
        maps(configuration.maps, configuration.map_cache_bytes, configuration.search_cache_bytes),
        detector(make_detector(configuration.detector)),
        pictures(configuration.picture_cache_bytes),
        tracks(configuration.tracks.empty() ? configuration.maps / "tracks.sqlite" : configuration.tracks,
               configuration.track_limits, maps, configuration.limits, configuration.calibration),
        service{maps,     *detector, configuration.limits,         configuration.http,       metrics,
                pictures, tracks,    configuration.search_threads, configuration.calibration},
        server(configuration.http, make_router(service), error_response, metrics) {
    metrics.gauge("roadfix_maps", "Maps being served.", [this] { return static_cast<double>(maps.maps().size()); });
    metrics.gauge("roadfix_maps_unreadable", "Map files that cannot be served.",
                  [this] { return static_cast<double>(maps.unreadable().size()); });
    metrics.gauge("roadfix_map_cache_bytes", "Decoded tiles in memory.",
                  [this] { return static_cast<double>(maps.cached_bytes()); });
    metrics.gauge("roadfix_search_cache_bytes", "What searches built of maps, kept for the next ones.",
                  [this] { return static_cast<double>(maps.search_cached_bytes()); });
    metrics.gauge("roadfix_picture_cache_bytes", "Rendered tiles in memory.",
                  [this] { return static_cast<double>(pictures.bytes()); });
  }

  const Configuration configuration;
  MapRegistry maps;
  std::unique_ptr<RoadDetector> detector;
  PictureCache pictures;
  http::Metrics metrics;
  TrackRegistry tracks;
  const Service service;
  http::Server server;
};

Application::Application(Configuration configuration) : parts_(std::make_unique<Parts>(std::move(configuration))) {}

Application::~Application() { stop(); }

int Application::start() {
  const int port = parts_->server.start();
  parts_->maps.watch(parts_->configuration.watch_interval);
  if (const auto problem = parts_->tracks.problem()) spdlog::warn("no tracks can be kept: {}", *problem);
  spdlog::info("detector: {}", parts_->detector->describe());
  return port;
}

void Application::stop() {
  parts_->tracks.stop();
  parts_->server.stop();
  parts_->maps.stop();
}

}  // namespace roadfix::server
