#include "server/application.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <exception>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "core/units/memory.hpp"
#include "core/units/parallel_for.hpp"
#include "server/api/problem.hpp"
#include "server/failure_log.hpp"
#include "server/maps/picture_cache.hpp"
#include "server/service.hpp"

namespace roadfix::server {
namespace {

constexpr std::size_t kMostFreed = std::size_t{128} << 20;  // for each processor

/// Faults of the service reach its log whole; the client learns only what it can act on.
http::ErrorResponse error_response() {
  return [failures = std::make_shared<FailureLog>()](const std::exception_ptr& thrown, const http::Request& request) {
    http::Response response = api::problem(thrown);
    if (const auto line = failures->line(thrown, response.status, request.id)) spdlog::error("{}", *line);
    return response;
  };
}

/// While the store of the tracks refuses, problem() and all who ask for a track say so.
void tidy(TrackRegistry& tracks) {
  try {
    tracks.tidy();
  } catch (const std::exception&) {
  }
}

void warn_of_another_reader(const ServedMap& map, const Detectors& detectors) {
  const std::optional<std::string>& reader = map.view.imagery_reader;
  if (detectors.include_reader(reader)) return;
  spdlog::warn("map {} was read by {}: frames are read by another detector here, and fixes of them are fewer",
               map.name(), *reader);
}

}  // namespace

struct Application::Parts {
  explicit Parts(Configuration c)
      : configuration(std::move(c)),
        detectors(configuration.detector),
        maps(configuration.maps, configuration.map_cache_bytes,
             [this](const ServedMap& map) { warn_of_another_reader(map, detectors); }),
        pictures(configuration.picture_cache_bytes),
        tracks(configuration.tracks.empty() ? configuration.maps / "tracks.sqlite" : configuration.tracks,
               configuration.track_limits, maps, configuration.limits, configuration.calibration),
        search_threads(configuration.search_threads),
        service{.maps = maps,
                .detectors = detectors,
                .limits = configuration.limits,
                .http = configuration.http,
                .metrics = metrics,
                .pictures = pictures,
                .tracks = tracks,
                .steps = steps,
                .search_threads = search_threads,
                .calibration = configuration.calibration},
        server(configuration.http, make_router(service), error_response(), metrics) {
    metrics.describe(kAnswers, "Fixes and steps of tracks by their status.");
    metrics.gauge("process_start_time_seconds", "When the service started, in seconds since 1970.",
                  [start = std::chrono::system_clock::now()] {
                    return std::chrono::duration<double>(start.time_since_epoch()).count();
                  });
    metrics.gauge("roadfix_tracks_available", "1 where the store of the tracks is open and took the last step, else 0.",
                  [this] { return tracks.problem() ? 0.0 : 1.0; });
    metrics.gauge("roadfix_tracks", "Tracks that fly, NaN where their store cannot say.", [this] {
      const auto flying = tracks.flying();
      return flying ? static_cast<double>(*flying) : std::numeric_limits<double>::quiet_NaN();
    });
    metrics.gauge("roadfix_track_streams", "Streams of track events that are open.",
                  [this] { return static_cast<double>(tracks.streams()); });
    metrics.gauge("roadfix_maps", "Maps being served.", [this] { return static_cast<double>(maps.maps().size()); });
    metrics.gauge("roadfix_maps_unreadable", "Map files that cannot be served.",
                  [this] { return static_cast<double>(maps.unreadable().size()); });
    metrics.gauge("roadfix_maps_folder_readable", "1 where the last look at the map folder saw its files, else 0.",
                  [this] { return maps.problem() ? 0.0 : 1.0; });
    metrics.gauge("roadfix_map_cache_bytes", "Decoded tiles in memory.",
                  [this] { return static_cast<double>(maps.cached_bytes()); });
    metrics.gauge("roadfix_search_cache_bytes", "What searches built of maps, kept for the next ones.",
                  [this] { return static_cast<double>(maps.search_cached_bytes()); });
    metrics.gauge("roadfix_picture_cache_bytes", "Rendered tiles in memory.",
                  [this] { return static_cast<double>(pictures.bytes()); });
  }

  const Configuration configuration;
  const Detectors detectors;
  MapRegistry maps;
  PictureCache pictures;
  http::Metrics metrics;
  TrackRegistry tracks;
  TrackSteps steps{tracks};
  SearchThreads search_threads;
  const Service service;
  http::Server server;
};

Application::Application(Configuration configuration) : parts_(std::make_unique<Parts>(std::move(configuration))) {}

Application::~Application() { stop(); }

int Application::start() {
  const int port = parts_->server.start();
  parts_->maps.watch(parts_->configuration.watch_interval, [this] {
    tidy(parts_->tracks);
    give_back_freed_memory_beyond(kMostFreed * static_cast<std::size_t>(std::max(2, processors())));
  });
  if (const auto problem = parts_->tracks.problem()) spdlog::warn("tracks cannot be stored: {}", *problem);
  spdlog::info("detector: {}", parts_->detectors.describe());
  if (const auto note = note_on_missing_network(parts_->configuration.detector)) spdlog::warn(*note);
  return port;
}

void Application::stop() {
  parts_->tracks.stop();
  parts_->server.stop();
  parts_->maps.stop();
}

}  // namespace roadfix::server
