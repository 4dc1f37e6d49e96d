#include <fmt/format.h>

#include <optional>

#include "core/locate/levelled_fix.hpp"
#include "server/api/altitude_request.hpp"
#include "server/api/feature_request.hpp"
#include "server/api/fix_json.hpp"
#include "server/api/fix_request.hpp"
#include "server/api/flight_request.hpp"
#include "server/api/position_answer.hpp"
#include "server/api/time_limit.hpp"
#include "server/handlers/answers.hpp"
#include "server/handlers/handlers.hpp"
#include "server/tracks/track_times.hpp"

namespace roadfix::server {
namespace {

std::vector<std::string> fix_fields() {
  return joined({api::feature_fields(),
                 api::altitude_fields(),
                 api::prior_fields(),
                 api::fix_option_fields(),
                 api::position_fields(),
                 {"time_us"}});
}

/// The frame was captured at time_us, or when the request came.
api::PositionTime time_of(const http::Request& request, std::optional<std::int64_t> time_us) {
  const auto spent = time_spent(request);
  return {time_us.value_or(now_us() - spent.count()), spent};
}

api::Features features_of(const Service& service, const http::Request& request, const api::Content& content,
                          const MapView& map) {
  const api::TimeLimit limit(request.deadline, request.abandoned);
  const auto detector = service.detectors.for_map(map.imagery_reader);
  return api::flight_features_of(content, {*detector, map.cell_m, limit.token()}, service.limits);
}

http::Response post_fix(const Service& service, const http::Request& request) {
  const auto map = service.maps.find(request.path_parameters.at("map"));
  api::Content content = api::read_content(request, joined({fix_fields(), api::flight_members()}), service.limits);
  const api::PositionFormat format = api::parse_position_format(request, content.fields);
  const auto time_us = content.fields.optional_large_integer("time_us", 0);
  const Prior prior = api::parse_prior(content.fields);
  FixOptions options = api::parse_fix_options(content.fields, service.limits);
  const auto time_limit = api::parse_time_limit(content.fields);
  // Before the frame, which costs a turn among the searches.
  const PoseRegion region = search_region(map->view, prior, options);
  auto altitude = api::take_altitude(
      content, [&](double above_sea_m) { return required_agl_m(map->view, region.box, above_sea_m); });
  api::Features features = features_of(service, request, content, map->view);
  if (!altitude) altitude = api::altitude_in_file(features);
  options.calibration = service.calibration;
  options.own_frame = std::move(features.own_frame);
  options.others = std::move(features.others);
  options.left_out = features.left_out;
  const api::HangUp hang_up(request.abandoned);
  const SearchThreads::Share share(service.search_threads);
  options.search.threads = share.threads();
  options.search.deadline = api::search_end(request.deadline, hang_up.token()).within(time_limit);
  const auto answer = api::to_json(locate_levelled(altitude, map->view, features.map, prior, options), features);
  const std::string status = answer.at("status");
  service.metrics.count(kAnswers, fmt::format("kind=\"fix\",status=\"{}\"", status));
  http::Response response =
      format.is_json() ? json_response(answer) : api::position_response(answer, format, time_of(request, time_us));
  response.answer = status;
  return response;
}

}  // namespace

void add_fix_route(Routes& routes) {
  routes.add("POST", "/v1/maps/{map}/fix", fix_fields(), post_fix, http::Load::kHeavy);
}

}  // namespace roadfix::server
