// What the handlers share, and the table of routes made of them.
#pragma once

#include <memory>

#include "core/detect/detectors.hpp"
#include "core/locate/calibration.hpp"
#include "server/api/limits.hpp"
#include "server/http/metrics.hpp"
#include "server/http/router.hpp"
#include "server/http/server.hpp"
#include "server/maps/map_registry.hpp"
#include "server/maps/picture_cache.hpp"
#include "server/search_threads.hpp"
#include "server/tracks/track_steps.hpp"

namespace roadfix::server {

struct Service {
  MapRegistry& maps;
  const Detectors& detectors;
  const api::Limits& limits;
  const http::ServerSettings& http;
  http::Metrics& metrics;
  PictureCache& pictures;
  TrackRegistry& tracks;
  TrackSteps& steps;
  SearchThreads& search_threads;
  std::shared_ptr<const Calibration> calibration = shipped_calibration();  ///< never nullptr
};

/// How often what was answered: the one figure that tells a service that works from one that only runs.
constexpr const char* kAnswers = "roadfix_answers_total";

/// Every route of the service; schema/openapi.json describes them. `service` must outlive the router's handlers.
http::Router make_router(const Service& service);

}  // namespace roadfix::server
